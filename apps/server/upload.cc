// A body of any size through a buffer of one.
#include "server/upload.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "server/counted.h"
#include "server/files.h"
#include "server/studio.h"

namespace motes::server {
namespace {

constexpr std::size_t max_uploads = 4;  ///< at a time
constexpr std::size_t block_bytes = std::size_t{1} << 18;

/// The files together have all the room there is.
struct NoRoom : std::exception {};

/// A file among the uploads, which is removed unless it is kept.
class PartialFile {
 public:
  PartialFile(std::string_view name, Site& site)
      : site_(site),
        path_(site.files.with_uploads([name](Uploads& u) { return u.place_for(name); })),
        stream_(path_, std::ios::binary) {}
  ~PartialFile() {
    if (!kept_) site_.files.with_uploads([this](Uploads& u) { u.remove(path_); });
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Makes room for so many bytes to come. Throws NoRoom.
  void expect(std::uint64_t bytes) {
    if (bytes <= room_) return;
    const auto in_use = site_.studio.files_in_use();
    if (!site_.files.with_uploads(
            [&](Uploads& u) { return u.grow(path_, bytes - room_, in_use); })) {
      throw NoRoom();
    }
    room_ = bytes;
  }
  void write(const char* data, std::size_t size) {
    expect(size);
    room_ -= size;
    if (!stream_.write(data, static_cast<std::streamsize>(size))) fail();
  }
  void keep() {
    stream_.close();
    if (!stream_) fail();
    kept_ = true;
    site_.files.with_uploads([this](Uploads& u) { u.complete(path_); });
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail() const {
    throw Error(path_.filename(), "cannot be written: is the server's disk full?");
  }

  Site& site_;
  std::filesystem::path path_;
  std::ofstream stream_;
  std::uint64_t room_ = 0;  ///< for bytes to come
  bool kept_ = false;
};

std::string bytes_text(std::uint64_t bytes) {
  constexpr double mebi = 1 << 20;
  const double size = static_cast<double>(bytes) / mebi;
  return size < 1      ? fmt::format("{} bytes", bytes)
         : size < 1024 ? fmt::format("{:.3g} MiB", size)
                       : fmt::format("{:.3g} GiB", size / 1024);
}

asio::awaitable<void> copy_body(http::request_parser<http::buffer_body>& parser,
                                beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                PartialFile& file, std::chrono::milliseconds timeout) {
  std::vector<char> block(block_bytes);
  while (!parser.is_done()) {
    parser.get().body().data = block.data();
    parser.get().body().size = block.size();
    stream.expires_after(timeout);
    boost::system::error_code error;
    co_await http::async_read(stream, buffer, parser,
                              asio::redirect_error(asio::use_awaitable, error));
    if (error && error != http::error::need_buffer) throw boost::system::system_error(error);
    file.write(block.data(), block.size() - parser.get().body().size);
  }
}

}  // namespace

asio::awaitable<Answer> take_upload(const Target& target,
                                    http::request_parser<http::empty_body>& header,
                                    beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                    Site& site) {
  if (site.num_uploads >= max_uploads) {
    co_return text_answer(http::status::service_unavailable, "too many files are sent at a time");
  }
  const Counted counted(site.num_uploads);
  const Answer too_large = text_answer(http::status::payload_too_large,
                                       fmt::format("the server takes no file of more than {}",
                                                   bytes_text(site.options.max_upload_bytes)));
  if (const auto length = header.content_length();
      length && *length > site.options.max_upload_bytes) {
    co_return too_large;
  }
  try {
    PartialFile file(target.parameter("name"), site);
    if (const auto length = header.content_length()) file.expect(*length);
    http::request_parser<http::buffer_body> parser{std::move(header)};
    parser.body_limit(site.options.max_upload_bytes);
    if (parser.get()[http::field::expect] == "100-continue") {
      http::response<http::empty_body> go_on{http::status::continue_, 11};
      co_await http::async_write(stream, go_on, asio::use_awaitable);
    }
    co_await copy_body(parser, stream, buffer, file, site.options.timeouts.upload);
    file.keep();
    const nlohmann::json path{{"path", file.path().string()}};
    co_return Answer{http::status::ok, "application/json",
                     path.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"};
  } catch (const Error& error) {
    co_return text_answer(http::status::bad_request, error.what());
  } catch (const boost::system::system_error& error) {
    if (error.code() != http::error::body_limit) throw;
    co_return too_large;
  } catch (const NoRoom&) {
    co_return text_answer(
        http::status::insufficient_storage,
        fmt::format("the files that the server keeps may have no more than {} together",
                    bytes_text(site.options.max_kept_bytes)));
  }
}

}  // namespace motes::server
