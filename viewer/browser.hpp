/// @file
/// Opens the page in a browser.
#pragma once

#include <string>

namespace sinew::viewer {

/// Opens an address in the user's browser if there is a display. Failure to start a browser is not
/// an error, since the address has been printed.
void open_browser(const std::string& url);

}  // namespace sinew::viewer
