// A body of any size through a buffer of one.
#include "server/upload.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "server/files.h"

namespace motes::server {
namespace {

constexpr std::size_t max_uploads = 4;  ///< at a time
constexpr std::size_t block_bytes = std::size_t{1} << 18;

/// A file that is removed unless it is kept.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path path)
      : path_(std::move(path)), stream_(path_, std::ios::binary) {}
  ~PartialFile() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove_all(path_.parent_path(), ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  void write(const char* data, std::size_t size) {
    if (!stream_.write(data, static_cast<std::streamsize>(size))) {
      throw Error(path_, "cannot be written: is the disk full?");
    }
  }
  void keep() {
    stream_.close();
    if (!stream_) throw Error(path_, "cannot be written: is the disk full?");
    kept_ = true;
  }

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  bool kept_ = false;
};

/// Counts what is under way.
class Counted {
 public:
  explicit Counted(std::size_t& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::size_t& count_;
};

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
    co_return text_answer(http::status::service_unavailable, "too many uploads at a time");
  }
  const Counted counted(site.num_uploads);
  if (const auto length = header.content_length();
      length && *length > site.options.max_upload_bytes) {
    co_return text_answer(http::status::payload_too_large, "the file is too large");
  }
  try {
    const std::filesystem::path place = site.files.place_for_upload(target.parameter("name"));
    PartialFile file(place);
    http::request_parser<http::buffer_body> parser{std::move(header)};
    parser.body_limit(site.options.max_upload_bytes);
    if (parser.get()[http::field::expect] == "100-continue") {
      http::response<http::empty_body> go_on{http::status::continue_, 11};
      co_await http::async_write(stream, go_on, asio::use_awaitable);
    }
    co_await copy_body(parser, stream, buffer, file, site.options.timeouts.upload);
    file.keep();
    const nlohmann::json path{{"path", place.string()}};
    co_return Answer{http::status::ok,
                     "application/json",
                     path.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n",
                     {}};
  } catch (const Error& error) {
    co_return text_answer(http::status::bad_request, error.what());
  } catch (const boost::system::system_error& error) {
    if (error.code() != http::error::body_limit) throw;
    co_return text_answer(http::status::payload_too_large, "the file is too large");
  }
}

}  // namespace motes::server
