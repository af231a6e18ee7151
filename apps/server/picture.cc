// Asks the studio for a picture and waits without holding up the network.
#include "server/picture.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/error.h"
#include "image/write_image.h"
#include "server/studio.h"

namespace motes::server {
namespace {

/// An answer that another thread gives to a coroutine.
class Awaited {
 public:
  explicit Awaited(const asio::any_io_executor& executor)
      : timer_(executor, asio::steady_timer::time_point::max()) {}

  /// From any thread, once.
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

asio::awaitable<Answer> make_picture(const Target& target, Site& site) {
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
  const auto awaited = std::make_shared<Awaited>(co_await asio::this_coro::executor);
  site.studio.picture(request, [awaited, name, format = request.format](
                                   std::optional<std::string> file, const std::string& error) {
    if (!file) {
      return Awaited::give(awaited, text_answer(http::status::unprocessable_entity, error));
    }
    Answer answer{http::status::ok, mime_type(format), std::move(*file), {}};
    answer.headers.emplace_back("Content-Disposition",
                                fmt::format("attachment; filename=\"{}\"", name));
    Awaited::give(awaited, std::move(answer));
  });
  co_return co_await awaited->wait();
}

}  // namespace motes::server
