/// @file
/// How much a browser, or whoever says that it is one, may ask of the server.
#pragma once

#include <chrono>
#include <cstddef>

namespace sinew::viewer::limits {

inline constexpr double kSlowest = 0.01, kFastest = 100.0;  ///< simulated seconds a second
/// Whether a run can be shown at this speed; 0: as fast as it can.
constexpr bool is_speed(double factor) {
  return factor == 0.0 || (factor >= kSlowest && factor <= kFastest);
}

inline constexpr std::size_t kConnections = 32;  ///< open at once, pages and their views together
inline constexpr std::size_t kRequestHeader = 8192;       ///< bytes of an HTTP request
inline constexpr std::chrono::seconds kRequestTime{10};   ///< for a whole HTTP request
inline constexpr std::chrono::minutes kDownloadTime{10};  ///< for a file to be saved
inline constexpr std::chrono::seconds kHelloTime{5};      ///< for the first message of a view
inline constexpr std::chrono::seconds kIdleTime{30};      ///< until a silent view is pinged
inline constexpr double kMessagesPerSecond = 240.0;
inline constexpr double kMessageBurst = 480.0;          ///< messages at once
inline constexpr std::size_t kQueuedText = 256 * 1024;  ///< bytes not yet taken by a slow view
inline constexpr std::size_t kPendingRequests = 256;    ///< of one view, not yet answered
inline constexpr std::size_t kRecordedRows = std::size_t{128}
                                             << 20;  ///< bytes of run.csv's numbers
inline constexpr std::size_t kTimelineBytes = std::size_t{128} << 20;  ///< of states to go back to
inline constexpr double kTimelineSeconds = 60.0;  ///< simulated; how far a run can go back
inline constexpr std::chrono::milliseconds kStatusInterval{100};

}  // namespace sinew::viewer::limits
