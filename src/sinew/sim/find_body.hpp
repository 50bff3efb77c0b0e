/// @file
/// The bodies of a model under construction, as what acts on them names them.
#pragma once

namespace sinew {
struct Location;
}
namespace sinew::fem {
class HasElements;
}
namespace sinew::mechanics {
class BodyModel;
}

namespace sinew::sim {

struct ModelData;

/// @param data with the bodies. @param index as it was given. @param place of what names it. Throws
/// Error(unknown-name).
mechanics::BodyModel& find_body(ModelData& data, int index, const Location& place);

/// A body of finite elements. @param data,index,place as find_body()'s. @param what is for such
/// bodies alone: "loads". Throws Error: unknown-name, wrong-type.
fem::HasElements& find_elements(ModelData& data, int index, const Location& place,
                                const char* what);

}  // namespace sinew::sim
