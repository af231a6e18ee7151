// Where the studio puts what a client is to get.
#pragma once

#include <cstdint>
#include <string>

namespace motes::server {

/// The sending end of a client's connection. For the studio's threads: safe from any thread, never
/// waits.
class Outlet {
 public:
  virtual ~Outlet() = default;
  virtual void send_text(std::string text) = 0;
  /// A frame_message(). One that has not left when the next comes is dropped for it.
  virtual void send_frame(std::string message) = 0;
  /// What has not left yet of the frame of that number need not come any more.
  virtual void recall_frame(std::uint32_t frame) = 0;
};

}  // namespace motes::server
