/// @file
/// Checked access to the bodies of a model under construction.
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

/// A body by index. @param data with the bodies. @param index as given.
/// @param place source location of the reference. Throws Error(unknown-name).
mechanics::BodyModel& find_body(ModelData& data, int index, const Location& place);

/// A body of finite elements by index. @param data,index,place as for find_body().
/// @param what needs such a body, for the message: "loads". Throws Error: unknown-name, wrong-type.
fem::HasElements& find_elements(ModelData& data, int index, const Location& place,
                                const char* what);

}  // namespace sinew::sim
