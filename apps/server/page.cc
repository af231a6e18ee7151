// The assembler puts the built page into the program as it is.
#include "server/page.h"

#include <fmt/format.h>

#include <cstddef>

asm(R"(
  .section .rodata
  .balign 16
motes_page_begin:
  .incbin ")" MOTES_PAGE R"("
motes_page_end:
  .byte 0
  .text
)");

extern const char motes_page_begin[], motes_page_end[];

namespace motes::server {

std::string page_html(std::string_view nonce) {
  constexpr std::string_view mark = "{{nonce}}";
  const std::string_view page(motes_page_begin,
                              static_cast<std::size_t>(motes_page_end - motes_page_begin));
  std::string out;
  std::size_t done = 0;
  for (auto at = page.find(mark); at != page.npos; at = page.find(mark, done)) {
    out += page.substr(done, at - done);
    out += nonce;
    done = at + mark.size();
  }
  out += page.substr(done);
  return out;
}

std::string content_security_policy(std::string_view nonce) {
  return fmt::format(
      "default-src 'none'; script-src 'nonce-{}'; style-src 'unsafe-inline'; img-src blob: data:; "
      "connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'",
      nonce);
}

}  // namespace motes::server
