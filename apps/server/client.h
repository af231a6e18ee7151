// A page without a screen, as far as the server can tell: for tests and benchmarks.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/frame_message.h"

namespace motes::server {

/// A picture as it has come.
struct ReceivedFrame {
  FrameHeader header;
  std::string image;  ///< a JPEG or PNG file
};

/// One socket of a server on this machine. Its functions throw boost::system::system_error where
/// the server refuses or has closed it. Whoever does not read answers no ping either.
class Client {
 public:
  using Clock = std::chrono::steady_clock;

  /// `receive_buffer`: bytes that the system takes before they are read; by default as it likes.
  Client(std::uint16_t port, std::string_view token, std::optional<int> receive_buffer = {});
  /// Goes without a word, as a killed browser does.
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view text);
  void set_size(int width, int height);
  /// `camera` as in scene files.
  void look(std::uint32_t sequence, const nlohmann::json& camera, bool moving);
  void acknowledge(std::uint32_t frame);

  /// The next message, text or frame; nullopt: none has come by then.
  std::optional<std::string> read(Clock::time_point deadline = Clock::time_point::max());
  /// The next text of a type; frames on the way are acknowledged. Throws Error for a text of type
  /// "error", unless that is waited for.
  nlohmann::json wait_for(std::string_view type);
  /// The next frame that is whole, acknowledged if that is wanted; texts on the way are left out.
  ReceivedFrame wait_for_frame(bool acknowledged = true);
  /// The next full picture.
  ReceivedFrame wait_for_final();
  /// Reads until the server closes; with which code. 0: without a word.
  int wait_for_close();
  /// Says goodbye.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace motes::server
