#include "sinew/fem/of_elements.hpp"

#include "sinew/core/error.hpp"

namespace sinew::fem {

void throw_not_of_elements(const std::string& name) {
  throw Error(ErrorKind::wrong_type, {.item = name}, "this body is not of finite elements",
              "ask for its own coordinates");
}

}  // namespace sinew::fem
