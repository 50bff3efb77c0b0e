#include "sinew/model/named_index.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/core/error.hpp"

namespace sinew::model {

void throw_unknown_name(std::string_view name, const char* what,
                        const std::vector<std::string>& known) {
  const std::string near = nearest_word(name, known);
  const std::string remedy = !near.empty()   ? fmt::format("did you mean '{}'?", near)
                             : known.empty() ? fmt::format("the robot has no {}", what)
                                             : fmt::format("there are: {}", fmt::join(known, ", "));
  throw Error(ErrorKind::unknown_name, {.item = std::string(name)},
              fmt::format("no {} is called '{}'", what, name), remedy);
}

}  // namespace sinew::model
