// What a request is answered.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/asio.h"

namespace motes::server {

struct Answer {
  http::status status = http::status::ok;
  std::string type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< besides those all have
  std::shared_ptr<const void> hold = nullptr;                     ///< let go when it has been sent
};

inline Answer text_answer(http::status status, const std::string& line) {
  return {status, "text/plain; charset=utf-8", line + "\n"};
}

}  // namespace motes::server
