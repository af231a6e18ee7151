// Asks the studio for a picture and waits without holding up the network.
#include "server/picture.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/error.h"
#include "image/write_image.h"
#include "server/counted.h"
#include "server/studio.h"

namespace motes::server {
namespace {

/// One is rendered while others wait, or are sent: such a file may be of gigabytes.
constexpr std::size_t max_pictures = 4;

/// An answer that another thread gives to a coroutine.
class Awaited {
 public:
  explicit Awaited(const asio::any_io_executor& executor)
      : timer_(executor, asio::steady_timer::time_point::max()) {}

  /// From any thread; the first counts.
  static void give(const std::shared_ptr<Awaited>& awaited, Answer answer) {
    asio::post(awaited->timer_.get_executor(), [awaited, answer = std::move(answer)]() mutable {
      awaited->answer_ = std::move(answer);
      awaited->timer_.cancel();
    });
  }

  asio::awaitable<Answer> wait() {
    boost::system::error_code woken;
    if (!answer_) co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
    co_return std::move(answer_).value();
  }

 private:
  asio::steady_timer timer_;
  std::optional<Answer> answer_;
};

/// Looks, while it lives, whether the client goes away: its side of the connection ends.
class Departure {
 public:
  template <class F>
  Departure(asio::ip::tcp::socket& socket, F on_departure) : socket_(socket) {
    socket.async_wait(
        asio::ip::tcp::socket::wait_read,
        [&socket, looks = looks_, on_departure](const boost::system::error_code& error) {
          if (error || !*looks) return;
          char next = 0;
          boost::system::error_code failed;
          const std::size_t size =
              socket.receive(asio::buffer(&next, 1), asio::ip::tcp::socket::message_peek, failed);
          if (failed || size == 0) on_departure();
        });
  }
  ~Departure() {
    *looks_ = false;
    boost::system::error_code ignored;
    socket_.cancel(ignored);
  }
  Departure(const Departure&) = delete;
  Departure& operator=(const Departure&) = delete;

 private:
  asio::ip::tcp::socket& socket_;
  std::shared_ptr<bool> looks_ = std::make_shared<bool>(true);  ///< it still lives
};

const char* mime_type(ImageFormat format) {
  switch (format) {
    case ImageFormat::png:
      return "image/png";
    case ImageFormat::jpeg:
      return "image/jpeg";
    default:
      return "application/octet-stream";
  }
}

}  // namespace

asio::awaitable<Answer> make_picture(const Target& target, asio::ip::tcp::socket& socket,
                                     Site& site) {
  const auto client = parse_number(target.parameter("client"), 1, 1 << 30);
  const auto width = parse_number(target.parameter("width"), 1, max_picture_side);
  const auto height = parse_number(target.parameter("height"), 1, max_picture_side);
  const std::string name = fmt::format("picture.{}", target.parameter("format"));
  if (!client || !width || !height) {
    co_return text_answer(http::status::bad_request,
                          "expected client, width and height as whole numbers");
  }
  PictureRequest request{static_cast<ClientId>(*client), *width, *height};
  try {
    request.format = image_format(name);
  } catch (const Error& error) {
    co_return text_answer(http::status::bad_request, error.what());
  }
  if (site.num_pictures >= max_pictures) {
    co_return text_answer(http::status::service_unavailable,
                          "other pictures are being made: try again when they are done");
  }
  const auto counted = std::make_shared<Counted>(site.num_pictures);
  const auto awaited = std::make_shared<Awaited>(co_await asio::this_coro::executor);
  site.studio.picture(request, [awaited, name, format = request.format](
                                   std::optional<std::string> file, const std::string& error) {
    if (!file) {
      return Awaited::give(awaited, text_answer(http::status::unprocessable_entity, error));
    }
    Answer answer{http::status::ok, mime_type(format), std::move(*file)};
    answer.headers.emplace_back("Content-Disposition",
                                fmt::format("attachment; filename=\"{}\"", name));
    Awaited::give(awaited, std::move(answer));
  });
  const Departure departure(socket, [&studio = site.studio, request, awaited] {
    studio.abandon(request);
    Awaited::give(awaited, {});
  });
  Answer answer = co_await awaited->wait();
  answer.hold = counted;
  co_return answer;
}

}  // namespace motes::server
