// The page, web/, as it was built into the program.
#pragma once

#include <string>
#include <string_view>

namespace motes::server {

/// Its HTML, with scripts and styles inside, for which `nonce` is let through by the policy that
/// goes with it.
std::string page_html(std::string_view nonce);
std::string content_security_policy(std::string_view nonce);

}  // namespace motes::server
