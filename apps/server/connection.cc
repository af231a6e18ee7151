// Requests in, answers out: who may ask is decided here, before anything else is done.
#include "server/connection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "server/answer.h"
#include "server/answers.h"
#include "server/files.h"
#include "server/page.h"
#include "server/picture.h"
#include "server/studio.h"
#include "server/target.h"
#include "server/upload.h"

namespace motes::server {
namespace {

using namespace std::chrono_literals;

constexpr auto leave_timeout = 3s;
constexpr std::uint32_t max_header_bytes = 16384;

/// The refusal, or where the request leads.
struct Admission {
  std::optional<Target> target;
  http::status refusal = http::status::bad_request;
  std::string reason;
};

Admission admit(const Site& site, const Socket::Request& request) {
  const auto header = [&request](http::field name) -> std::string_view {
    const auto value = request[name];
    return {value.data(), value.size()};
  };
  const std::string refusal =
      site.hosts.refusal(header(http::field::host), header(http::field::origin));
  if (!refusal.empty()) return {{}, http::status::forbidden, refusal};
  const auto text = request.target();
  auto target = parse_target({text.data(), text.size()});
  if (!target) return {{}, http::status::bad_request, "expected a path"};
  if (!equal_in_constant_time(target->parameter("token"), site.token)) {
    return {{},
            http::status::forbidden,
            "the token is missing or wrong: open the address that motes view has printed"};
  }
  const std::string& base = site.options.base_url;  // "/" or "/name/"
  if (!target->path.starts_with(base))
    return {{}, http::status::not_found, "there is no such page"};
  target->path.erase(0, base.size() - 1);
  return {std::move(target), {}, ""};
}

/// What could not be opened is of no use, unless it is shown from before. On the studio's thread.
void discard_upload(Site& site, const std::filesystem::path& path) {
  const auto in_use = site.studio.files_in_use();
  if (std::find(in_use.begin(), in_use.end(), path) != in_use.end()) return;
  site.files.with_uploads([&path](Uploads& uploads) { uploads.remove(path); });
}

/// Waits for messages of one client and passes them on.
class Reception : public Socket::Receiver {
 public:
  explicit Reception(Site& site) : site_(site) {}

  void receive(Socket& from, const Message& message) override {
    if (const auto* list = std::get_if<ListMessage>(&message)) return answer_list(from, *list);
    if (const auto* open = std::get_if<OpenMessage>(&message)) return answer_open(from, *open);
    if (const auto* scene = std::get_if<SceneMessage>(&message)) return take_scene(from, *scene);
    site_.studio.handle(from.id(), message);
  }

 private:
  void answer_list(Socket& from, const ListMessage& message) {
    try {
      from.send_text(listing_text(message.path, site_.files.folder().list(message.path)));
    } catch (const Error& error) {
      from.send_text(error_text(std::nullopt, error.what()));
    }
  }

  void answer_open(Socket& from, const OpenMessage& message) {
    try {
      const auto path = site_.files.resolve(message.path);
      Opening opening{path.filename().string(),
                      [&files = site_.files, path] { return files.open_scene(path); }, from.id()};
      opening.failed = [&site = site_, path](const auto&) { discard_upload(site, path); };
      site_.studio.open(std::move(opening));
    } catch (const Error& error) {
      from.send_text(error_text(std::nullopt, error.what()));
    }
  }

  void take_scene(Socket& from, const SceneMessage& message) {
    try {
      Scene scene = site_.files.parse_scene(message.scene, site_.files.folder().path());
      site_.studio.set_scene(from.id(), message.sequence, std::move(scene));
    } catch (const Error& error) {
      from.send_text(error_text(message.sequence, error.what()));
    }
  }

  Site& site_;
};

asio::awaitable<void> serve_socket(beast::tcp_stream stream, const Socket::Request& request,
                                   Site& site) {
  const ClientId id = ++site.last_client;
  const auto socket = std::make_shared<Socket>(std::move(stream), id, site.options.timeouts);
  const bool too_many = site.sockets.size() >= site.options.max_clients;
  Reception reception(site);
  if (too_many) {
    socket->close(close_too_many, "too many clients");
  } else {
    site.sockets.emplace(id, socket);
    socket->send_text(hello_text(id, site.files.uploads_folder()));
    site.studio.connect(id, socket);
  }
  try {
    co_await socket->run(request, reception);
  } catch (const std::exception&) {
    // The handshake failed: nobody is there to be told.
  }
  site.studio.disconnect(id);
  site.sockets.erase(id);
}

/// Header lines that every answer has.
template <class Response>
void set_common_headers(Response& response) {
  response.set(http::field::server, "motes");
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");  // the token is part of the address
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("X-Frame-Options", "DENY");
}

Answer page_answer() {
  const std::string nonce = make_token();
  Answer answer{http::status::ok, "text/html; charset=utf-8", page_html(nonce)};
  answer.headers.emplace_back("Content-Security-Policy", content_security_policy(nonce));
  return answer;
}

asio::awaitable<Answer> answer_to(const Target& target,
                                  http::request_parser<http::empty_body>& parser,
                                  beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                  Site& site) {
  const http::verb method = parser.get().method();
  if (target.path == "/upload") {
    if (method != http::verb::post) {
      co_return text_answer(http::status::method_not_allowed, "expected POST");
    }
    co_return co_await take_upload(target, parser, stream, buffer, site);
  }
  if (method != http::verb::get && method != http::verb::head) {
    co_return text_answer(http::status::method_not_allowed, "expected GET");
  }
  if (target.path == "/") co_return page_answer();
  if (target.path == "/picture") co_return co_await make_picture(target, stream.socket(), site);
  co_return text_answer(http::status::not_found, "there is no such page");
}

/// Those who do not know the token are counted by themselves, so that they keep nobody out.
bool come_too_fast(Site& site, const Admission& admission) {
  RateLimit& rate = admission.target ? site.requests : site.refusals;
  return !rate.take(RateLimit::Clock::now());
}

asio::awaitable<void> send(beast::tcp_stream& stream, Answer answer, unsigned version, bool head,
                           bool keep_alive, std::chrono::milliseconds timeout) {
  http::response<http::string_body> response{answer.status, version};
  set_common_headers(response);
  response.set(http::field::content_type, answer.type);
  for (const auto& [name, value] : answer.headers) response.set(name, value);
  response.keep_alive(keep_alive);
  response.body() = std::move(answer.body);
  response.prepare_payload();
  if (head) response.body().clear();
  http::response_serializer<http::string_body> serializer{response};
  stream.expires_after(timeout);
  if (head) {
    co_await http::async_write_header(stream, serializer, asio::use_awaitable);
  } else {
    co_await http::async_write(stream, serializer, asio::use_awaitable);
  }
}

/// Ends a connection so that its last answer arrives: what a client still sends, such as a body
/// that is refused, is read for a while, since the system would else take back the answer.
asio::awaitable<void> take_leave(beast::tcp_stream& stream) {
  boost::system::error_code error;
  stream.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
  std::array<char, 65536> nobody_reads{};
  stream.expires_after(leave_timeout);
  while (!error) {
    co_await stream.async_read_some(asio::buffer(nobody_reads),
                                    asio::redirect_error(asio::use_awaitable, error));
  }
}

/// One request after the other; returns when the connection is done with.
asio::awaitable<void> serve_requests(beast::tcp_stream& stream, Site& site) {
  beast::flat_buffer buffer;
  for (bool keep_alive = true; keep_alive;) {
    http::request_parser<http::empty_body> parser;
    parser.header_limit(max_header_bytes);
    parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // uploads have their own
    stream.expires_after(site.options.timeouts.request);
    co_await http::async_read_header(stream, buffer, parser, asio::use_awaitable);
    const auto& request = parser.get();
    Admission admission = admit(site, request);
    if (come_too_fast(site, admission)) {
      admission = {{}, http::status::too_many_requests, "too many requests: try again in a second"};
    }
    if (admission.target && websocket::is_upgrade(request)) {
      if (admission.target->path == "/socket") {
        const auto upgrade = request;
        co_await serve_socket(std::move(stream), upgrade, site);
        co_return;
      }
      admission = {{}, http::status::not_found, "there is no such socket"};
    }
    Answer answer = text_answer(admission.refusal, admission.reason);
    // A body that nobody reads must not be taken for the next request.
    keep_alive = request.keep_alive() && parser.is_done() && admission.target.has_value();
    const bool head = request.method() == http::verb::head;
    const unsigned version = request.version();
    if (admission.target) {
      answer = co_await answer_to(*admission.target, parser, stream, buffer, site);
    }
    co_await send(stream, std::move(answer), version, head, keep_alive,
                  site.options.timeouts.taking);
  }
  co_await take_leave(stream);
}

}  // namespace

asio::awaitable<void> serve_connection(beast::tcp_stream stream, Site& site) {
  ++site.num_connections;
  try {
    co_await serve_requests(stream, site);
  } catch (const std::exception&) {
    // The client has gone, was too slow, or spoke no HTTP: it is left.
  }
  --site.num_connections;
}

}  // namespace motes::server
