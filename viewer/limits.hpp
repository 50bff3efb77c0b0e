/// @file
/// Limits on the requests of a browser, or of a program that pretends to be one.
#pragma once

#include <chrono>
#include <cstddef>

namespace sinew::viewer::limits {

inline constexpr double kSlowest = 0.01, kFastest = 100.0;  ///< simulated seconds per second
/// Whether a speed is allowed; 0 means as fast as possible.
constexpr bool is_speed(double factor) {
  return factor == 0.0 || (factor >= kSlowest && factor <= kFastest);
}

inline constexpr std::size_t kConnections = 32;          ///< open at once, pages and views together
inline constexpr std::size_t kRequestHeader = 8192;      ///< bytes of an HTTP request
inline constexpr std::chrono::seconds kRequestTime{10};  ///< for a whole HTTP request
inline constexpr std::chrono::minutes kDownloadTime{10};  ///< for a download
inline constexpr std::chrono::seconds kHelloTime{5};      ///< for the first message of a view
inline constexpr std::chrono::seconds kIdleTime{30};      ///< after which a silent view is pinged
inline constexpr double kMessagesPerSecond = 240.0;
inline constexpr double kMessageBurst = 480.0;          ///< messages at once
inline constexpr std::size_t kQueuedText = 256 * 1024;  ///< bytes waiting for a slow view
inline constexpr std::size_t kPendingRequests = 256;    ///< unanswered requests of one view
inline constexpr std::size_t kRecordedRows = std::size_t{128}
                                             << 20;  ///< bytes of the numbers in run.csv
inline constexpr std::size_t kTimelineBytes = std::size_t{128} << 20;  ///< of kept states
inline constexpr double kTimelineSeconds = 60.0;  ///< simulated time that a run can go back
inline constexpr std::chrono::milliseconds kStatusInterval{100};

}  // namespace sinew::viewer::limits
