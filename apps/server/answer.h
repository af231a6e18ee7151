// What a request is answered.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/asio.h"

namespace motes::server {

struct Answer {
  http::status status = http::status::ok;
  std::string type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< besides those all answers have
};

inline Answer text_answer(http::status status, const std::string& line) {
  return {status, "text/plain; charset=utf-8", line + "\n", {}};
}

}  // namespace motes::server
