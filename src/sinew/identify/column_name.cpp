#include "sinew/identify/column_name.hpp"

#include <cctype>

namespace sinew::identify {

std::string plain_name(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == '_' || c == '-') c = ' ';
  }
  return result;
}

}  // namespace sinew::identify
