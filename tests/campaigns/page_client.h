// tests/campaigns/page_client.h -- a client of the page's protocol that draws nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace cordis::test {

/// Reads the frames of a viz_node and acknowledges each, on a thread of its own. Connects again
/// whenever the connection ends.
class PageClient {
 public:
  PageClient();
  ~PageClient();
  PageClient(const PageClient&) = delete;
  PageClient& operator=(const PageClient&) = delete;

  /// @param url  http://127.0.0.1:PORT, where to connect the next time
  void visit(const std::string& url);

  int frames() const noexcept { return frames_; }  ///< received so far

 private:
  void read();
  void read_from(std::uint16_t port);  ///< until the connection ends

  std::atomic<int> frames_{0};
  std::atomic<bool> ending_{false};
  std::mutex mutex_;  // of the next two
  std::string url_;
  int socket_ = -1;  // of the connection; -1: none
  std::thread thread_;
};

}  // namespace cordis::test
