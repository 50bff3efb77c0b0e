/// @file
/// Opening the page.
#pragma once

#include <string>

namespace sinew::viewer {

/// Opens an address in the user's browser where there is a screen. A browser that does not start is
/// no error: the address has been printed.
void open_browser(const std::string& url);

}  // namespace sinew::viewer
