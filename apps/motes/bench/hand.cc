// Does what the page does: acknowledges at once, then decodes, then shows.
#include "motes/bench/hand.h"

#include <chrono>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/stopwatch.h"
#include "core/vec.h"
#include "image/decode_jpeg.h"

namespace motes {
namespace {

using namespace std::chrono_literals;

constexpr int moves_per_second = 60, num_moves = 2 * moves_per_second;
/// A hand's: half a turn in four seconds.
constexpr double turn_of_move = std::numbers::pi / 4 / moves_per_second;

template <class Duration>
double in_ms(Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

Vector3d vector_of(const nlohmann::json& array) {
  return {array.at(0).get<double>(), array.at(1).get<double>(), array.at(2).get<double>()};
}

/// `camera`, as in scene files, turned about its target, with `up` upright.
nlohmann::json turned(nlohmann::json camera, double angle) {
  const Vector3d target = vector_of(camera.at("target"));
  const Vector3d arm = vector_of(camera.at("eye")) - target;
  const Vector3d axis = normalize(vector_of(camera.at("up")));
  const Vector3d along = dot(arm, axis) * axis;
  const Vector3d eye =
      target + along + std::cos(angle) * (arm - along) + std::sin(angle) * cross(axis, arm);
  camera["eye"] = {eye.x, eye.y, eye.z};
  return camera;
}

}  // namespace

/// A drag as it goes on.
struct Hand::Drag {
  struct Move {
    std::uint32_t sequence = 0;
    Clock::time_point at;
  };

  std::uint32_t first = 0;  ///< sequence of its first move
  DragTimes times;
  std::deque<Move> waiting;  ///< for a picture
};

Hand::Hand(const server::BackgroundServer& server, int width, int height)
    : client_(server.port(), server.token()), width_(width), height_(height) {
  const nlohmann::json scene = client_.wait_for("scene");
  camera_ = scene.at("scene").at("camera");
  num_particles_ = scene.at("data").at("particles");
  client_.set_size(width, height);
  client_.look(++sequence_, camera_, false);
  while (client_.wait_for_final().header.view_sequence != sequence_) {
  }
}

std::optional<server::ReceivedFrame> Hand::next_frame(Clock::time_point deadline) {
  while (const auto message = client_.read(deadline)) {
    const auto header = server::parse_frame_header(*message);
    if (header) {
      client_.acknowledge(header->frame);
      if (!server::is_whole(*header, *message)) continue;
      return server::ReceivedFrame{*header, message->substr(server::frame_header_bytes)};
    }
    const nlohmann::json text = nlohmann::json::parse(*message);
    if (text.at("type") == "error") throw Error(text.at("message").get<std::string>());
  }
  return {};
}

void Hand::look_until(Clock::time_point time, Drag& drag) {
  while (const auto frame = next_frame(time)) {
    if (frame->header.view_sequence < drag.first) continue;  // it was still on its way
    show(*frame, drag);
    ++drag.times.frames;
  }
}

void Hand::show(const server::ReceivedFrame& frame, Drag& drag) const {
  const server::FrameHeader& header = frame.header;
  // A client that was late with a move may be taken to rest, and get a full picture.
  if (header.format == server::FrameFormat::jpeg) {
    const Stopwatch decoding;
    decode_jpeg(frame.image);
    drag.times.decodes.push_back(decoding.milliseconds());
  }
  drag.times.renders.push_back(static_cast<double>(header.render_ms));
  drag.times.encodes.push_back(static_cast<double>(header.encode_ms));
  const double pixels = static_cast<double>(header.width) * header.height;
  drag.times.pixels.push_back(pixels / (static_cast<double>(width_) * height_));
  const Clock::time_point now = Clock::now();
  while (!drag.waiting.empty() && drag.waiting.front().sequence <= header.view_sequence) {
    drag.times.latencies.push_back(in_ms(now - drag.waiting.front().at));
    drag.waiting.pop_front();
  }
}

DragTimes Hand::drag() {
  // The picture is still being refined when the hand comes, and that has to be broken off.
  camera_ = turned(camera_, turn_of_move);
  client_.look(++sequence_, camera_, false);
  for (const auto come = Clock::now() + 100ms; next_frame(come);) {
  }
  Drag drag;
  drag.first = sequence_ + 1;
  const Clock::time_point begin = Clock::now();
  // A move happens when it is due, even if there is no time to say so at once.
  const auto due = [begin](int move) { return begin + move * (1'000'000us / moves_per_second); };
  for (int move = 0; move < num_moves; ++move) {
    look_until(due(move), drag);
    camera_ = turned(camera_, turn_of_move);
    client_.look(++sequence_, camera_, true);
    drag.waiting.push_back({sequence_, due(move)});
  }
  const Clock::time_point end = due(num_moves);
  look_until(end, drag);
  client_.look(++sequence_, camera_, false);
  drag.times.dragged = in_ms(end - begin);
  while (drag.times.full == 0) {
    const server::ReceivedFrame frame = next_frame(Clock::time_point::max()).value();
    const bool full = frame.header.final && frame.header.view_sequence == sequence_;
    if (full) drag.times.full = in_ms(Clock::now() - end);
    if (!drag.waiting.empty()) show(frame, drag);  // the last one that was asked for while moving
  }
  return drag.times;
}

std::vector<double> Hand::pick() {
  std::vector<double> times;
  for (const double x : {0.3, 0.5, 0.7}) {
    for (const double y : {0.3, 0.5, 0.7}) {
      const Stopwatch stopwatch;
      client_.send(nlohmann::json{
          {"type", "pick"}, {"sequence", ++sequence_}, {"x", x * width_}, {"y", y * height_}}
                       .dump());
      const bool hit = !client_.wait_for("picked").at("hit").is_null();
      if (hit) times.push_back(stopwatch.milliseconds());
    }
  }
  return times;
}

}  // namespace motes
