// VTK's XML files: docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, parsed by Expat.
#include "io/vti_header.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "core/error.h"
#include "io/text.h"

namespace motes {

namespace {

using Attributes = std::map<std::string, std::string, std::less<>>;

class VtiParser {
 public:
  VtiParser(const std::filesystem::path& path, std::string_view content)
      : path_(path), content_(content), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw Error(path_, "cannot be parsed: out of memory");
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
  }

  VtiHeader parse() {
    constexpr std::size_t block_bytes = std::size_t{16} << 20;
    for (std::string_view left = content_; !stopped_;) {
      const std::size_t n = std::min(block_bytes, left.size());
      const bool last = n == left.size();
      const auto status = XML_Parse(parser_.get(), left.data(), static_cast<int>(n), last ? 1 : 0);
      if (error_) std::rethrow_exception(error_);
      if (status != XML_STATUS_OK && !stopped_) {
        fail(fmt::format("is no good XML: {}", XML_ErrorString(XML_GetErrorCode(parser_.get()))));
      }
      if (last) break;
      left.remove_prefix(n);
    }
    if (num_pieces_ != 1) {
      throw Error(path_, fmt::format("has {} pieces of an image; expected 1", num_pieces_));
    }
    return std::move(header_);
  }

 private:
  // Exceptions must not pass through the C code of Expat: they wait in error_.
  template <class F>
  void guard(F&& f) {
    if (stopped_ || error_) return;
    try {
      f();
    } catch (...) {
      error_ = std::current_exception();
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }
  static void on_start(void* self, const char* name, const char** pairs) {
    auto& parser = *static_cast<VtiParser*>(self);
    parser.guard([&] {
      Attributes attributes;
      for (; *pairs != nullptr; pairs += 2) attributes.emplace(pairs[0], pairs[1]);
      parser.start(name, attributes);
    });
  }
  static void on_end(void* self, const char*) {
    auto& parser = *static_cast<VtiParser*>(self);
    parser.guard([&] {
      parser.open_.pop_back();
      if (parser.open_.size() < parser.array_depth_) parser.array_depth_ = 0;
    });
  }
  static void on_text(void* self, const char* text, int length) {
    auto& parser = *static_cast<VtiParser*>(self);
    parser.guard([&] {
      if (parser.open_.size() != parser.array_depth_) return;
      parser.header_.arrays.back().text.append(text, static_cast<std::size_t>(length));
    });
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(path_, XML_GetCurrentLineNumber(parser_.get()), message);
  }

  void start(const std::string& name, const Attributes& attributes) {
    const std::string parent = open_.empty() ? "" : open_.back();
    open_.push_back(name);
    if (parent.empty()) {
      start_file(name, attributes);
    } else if (name == "ImageData" && parent == "VTKFile") {
      start_image(attributes);
    } else if (name == "Piece" && parent == "ImageData") {
      ++num_pieces_;
      const std::string extent = need(attributes, "Extent", name);
      if (parse_extent(extent) != whole_extent_) {
        fail(fmt::format("expected one piece of the WholeExtent, found '{}'", printable(extent)));
      }
    } else if (name == "DataArray" && (parent == "PointData" || parent == "CellData")) {
      start_array(attributes, parent == "CellData");
    } else if (name == "AppendedData" && parent == "VTKFile") {
      start_appended(attributes);
    }
  }

  static std::string find(const Attributes& attributes, std::string_view name,
                          std::string_view fallback) {
    const auto it = attributes.find(name);
    return it == attributes.end() ? std::string(fallback) : it->second;
  }

  std::string need(const Attributes& attributes, std::string_view name,
                   std::string_view element) const {
    const auto it = attributes.find(name);
    if (it == attributes.end()) fail(fmt::format("expected the attribute {} of {}", name, element));
    return it->second;
  }

  /// `text`, if it is one of `words`.
  std::string one_of(const std::string& text, std::string_view attribute,
                     const std::vector<std::string>& words) const {
    if (std::find(words.begin(), words.end(), text) == words.end()) {
      fail(fmt::format("expected {} of {}, found '{}'", attribute, fmt::join(words, " or "),
                       printable(text)));
    }
    return text;
  }

  std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                    std::string_view what) const {
    std::vector<double> numbers;
    for (const std::string_view token : split_tokens(text)) {
      if (const auto value = to_real(token)) numbers.push_back(*value);
    }
    if (numbers.size() != count || split_tokens(text).size() != count) {
      fail(fmt::format("expected {} numbers in {}, found '{}'", count, what, printable(text)));
    }
    return numbers;
  }

  /// First and last index along each axis.
  std::vector<std::int64_t> parse_extent(const std::string& text) const {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    std::vector<std::int64_t> extent;
    bool good = true;
    for (const std::string_view token : split_tokens(text)) {
      const auto value = to_integer(token);
      good = good && value && *value >= -most && *value <= most;
      extent.push_back(value.value_or(0));
    }
    good = good && extent.size() == 6 && extent[0] <= extent[1] && extent[2] <= extent[3] &&
           extent[4] <= extent[5];
    if (!good) {
      fail(fmt::format(
          "expected an extent of 6 integers, first and last along each axis, found '{}'",
          printable(text)));
    }
    return extent;
  }

  void start_file(const std::string& name, const Attributes& attributes) {
    if (name != "VTKFile") fail(fmt::format("expected VTKFile, found '{}'", printable(name)));
    one_of(need(attributes, "type", name), "type", {"ImageData"});
    header_.big_endian = one_of(find(attributes, "byte_order", "LittleEndian"), "byte_order",
                                {"LittleEndian", "BigEndian"}) == "BigEndian";
    header_.header_bytes = one_of(find(attributes, "header_type", "UInt32"), "header_type",
                                  {"UInt32", "UInt64"}) == "UInt64"
                               ? 8
                               : 4;
    const std::string compressor = find(attributes, "compressor", "");
    if (!compressor.empty()) {
      one_of(compressor, "compressor", {"vtkZLibDataCompressor"});
      header_.compressed = true;
    }
  }

  void start_image(const Attributes& attributes) {
    whole_extent_ = parse_extent(need(attributes, "WholeExtent", "ImageData"));
    const auto origin = parse_numbers(find(attributes, "Origin", "0 0 0"), 3, "Origin");
    const auto spacing = parse_numbers(find(attributes, "Spacing", "1 1 1"), 3, "Spacing");
    // Rows of the matrix; its columns are the directions of the axes.
    const auto direction =
        parse_numbers(find(attributes, "Direction", "1 0 0 0 1 0 0 0 1"), 9, "Direction");
    Grid& points = header_.points;
    points.origin = {origin[0], origin[1], origin[2]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t first = whole_extent_[2 * axis], last = whole_extent_[2 * axis + 1];
      points.dims[axis] = static_cast<std::size_t>(last - first + 1);
      points.steps[axis] =
          spacing[axis] * Vector3d{direction[axis], direction[axis + 3], direction[axis + 6]};
      points.origin = points.origin + static_cast<double>(first) * points.steps[axis];
    }
  }

  void start_array(const Attributes& attributes, bool of_cells) {
    array_depth_ = open_.size();
    VtiArray array;
    array.line = XML_GetCurrentLineNumber(parser_.get());
    array.of_cells = of_cells;
    array.name = find(attributes, "Name", "");
    if (array.name.empty()) array.name = "value";
    array.type = need(attributes, "type", "DataArray");
    array.format =
        one_of(find(attributes, "format", "ascii"), "format", {"ascii", "binary", "appended"});
    array.num_components =
        count_of(find(attributes, "NumberOfComponents", "1"), "NumberOfComponents");
    if (array.format == "appended") {
      array.offset = count_of(need(attributes, "offset", "DataArray"), "offset");
    }
    header_.arrays.push_back(std::move(array));
  }

  std::uint64_t count_of(const std::string& text, std::string_view attribute) const {
    const auto count = to_count(text);
    if (!count)
      fail(fmt::format("expected a number for {}, found '{}'", attribute, printable(text)));
    return *count;
  }

  /// The appended data may be no XML: parsing ends here. They begin behind an underscore.
  void start_appended(const Attributes& attributes) {
    header_.appended_base64 =
        one_of(find(attributes, "encoding", "base64"), "encoding", {"raw", "base64"}) == "base64";
    const auto tag = static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()));
    const auto tag_bytes = static_cast<std::size_t>(XML_GetCurrentByteCount(parser_.get()));
    const std::string_view behind = content_.substr(tag + tag_bytes);
    const auto begin = std::find_if_not(behind.begin(), behind.end(), is_blank);
    if (begin == behind.end() || *begin != '_') fail("expected '_' before the appended data");
    header_.appended = {begin + 1, behind.end()};
    // What follows is not parsed, but its end tells whether the file is whole.
    std::string_view end = content_;
    while (!end.empty() && is_blank(end.back())) end.remove_suffix(1);
    if (!end.ends_with("</VTKFile>")) {
      throw Error(path_, "does not end with </VTKFile>; expected a whole file");
    }
    stopped_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  const std::filesystem::path& path_;
  std::string_view content_;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  std::exception_ptr error_;
  bool stopped_ = false;

  std::vector<std::string> open_;  ///< names of the elements
  std::size_t array_depth_ = 0;    ///< of an array whose text is collected; 0 outside of one
  std::size_t num_pieces_ = 0;
  std::vector<std::int64_t> whole_extent_;
  VtiHeader header_;
};

}  // namespace

VtiHeader parse_vti(const std::filesystem::path& path, std::string_view content) {
  return VtiParser(path, content).parse();
}

}  // namespace motes
