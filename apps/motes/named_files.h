// Files that options name, held against each other.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace motes {

/// Options and the files that they name; a file may be "", none.
using NamedFiles = std::vector<std::pair<std::string_view, std::filesystem::path>>;

/// No two outputs may be one file, and none may be the input. Throws Error.
void refuse_same_file(const NamedFiles& outputs, const NamedFiles::value_type& input);

}  // namespace motes
