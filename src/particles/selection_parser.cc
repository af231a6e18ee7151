// Recursive descent over the grammar of docs/scene.md, "Expressions"; each function is one level of
// precedence, loosest first.
#include "particles/selection_parser.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include "core/error.h"

namespace motes {
namespace {

// Deeper nesting is no expression of a person, and would overrun the machine's stack.
constexpr int max_depth = 64;

struct Function {
  std::string_view name;
  Operation operation;
};
constexpr Function functions[] = {
    {"abs", Operation::abs}, {"sqrt", Operation::sqrt}, {"log10", Operation::log10},
    {"exp", Operation::exp}, {"min", Operation::min},   {"max", Operation::max},
};

/// A property whose name nobody has checked may turn out to be a mistyped `species`: `unchecked`
/// stands for a number or a text, so that the mistake is told as one of the name.
enum class Type { number, text, condition, unchecked };

std::string_view name_of(Type type) {
  switch (type) {
    case Type::number:
    case Type::unchecked:
      return "a number";
    case Type::text:
      return "text";
    case Type::condition:
      return "a condition";
  }
  return "";
}

bool starts_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool continues_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Parser {
 public:
  Parser(std::string_view text, const CheckVariable& check) : text_(text), check_(check) {
    skip_blanks();
  }

  std::vector<Instruction> parse() {
    const std::size_t start = at_;
    expect(parse_or(), Type::condition, start, "the expression is");
    if (at_ < text_.size()) fail(at_, "expected an operator or the end, found " + found());
    return std::move(program_);
  }

 private:
  Type parse_or() { return parse_logical(Operation::logical_or, "||", "or", &Parser::parse_and); }
  Type parse_and() {
    return parse_logical(Operation::logical_and, "&&", "and", &Parser::parse_not);
  }

  Type parse_logical(Operation operation, std::string_view symbol, std::string_view word,
                     Type (Parser::*parse_operand)()) {
    const std::size_t left = at_;
    const Type type = (this->*parse_operand)();
    while (true) {
      const std::size_t column = at_;
      if (!accept(symbol) && !accept_word(word)) return type;
      expect(type, Type::condition, left, "left of " + std::string(symbol) + " is");
      const std::size_t right = at_;
      expect((this->*parse_operand)(), Type::condition, right,
             "right of " + std::string(symbol) + " is");
      emit(operation, column);
    }
  }

  Type parse_not() {
    const std::size_t column = at_;
    if (!accept_word("not")) return parse_comparison();
    const DepthGuard guard(*this);
    const std::size_t operand = at_;
    expect(parse_not(), Type::condition, operand, "'not' is followed by");
    emit(Operation::logical_not, column);
    return Type::condition;
  }

  std::optional<Operation> accept_comparison() {
    if (accept("==")) return Operation::equal;
    if (accept("!=")) return Operation::not_equal;
    if (accept("<=")) return Operation::less_equal;
    if (accept(">=")) return Operation::greater_equal;
    if (accept("<")) return Operation::less;
    if (accept(">")) return Operation::greater;
    if (peek() == '=') fail(at_, "expected '==' for a comparison, found '='");
    return std::nullopt;
  }

  Type parse_comparison() {
    const Type left = parse_sum();
    const std::size_t column = at_;
    const auto operation = accept_comparison();
    if (!operation) return left;
    const Type right = parse_sum();
    const bool open = left == Type::unchecked || right == Type::unchecked;
    const bool conditions = left == Type::condition || right == Type::condition;
    if (left != right && (!open || conditions)) {
      fail(column, fmt::format("cannot compare {} with {}{}", name_of(left), name_of(right),
                               left == Type::text || right == Type::text
                                   ? "; text is written in quotes, as in species == 'Si'"
                                   : ""));
    }
    const bool equality = *operation == Operation::equal || *operation == Operation::not_equal;
    for (const Type type : {left, right}) {
      if (type == Type::number || type == Type::unchecked || equality) continue;
      fail(column,
           fmt::format("expected numbers to compare, or == or !=, found {}", name_of(type)));
    }
    emit(*operation, column);
    const std::size_t next = at_;
    if (accept_comparison()) {
      fail(next, "comparisons do not chain: write 0 < z && z < 3, not 0 < z < 3");
    }
    return Type::condition;
  }

  Type parse_sum() {
    const std::size_t left = at_;
    const Type type = parse_product();
    while (true) {
      const std::size_t column = at_;
      const char c = peek();
      if (!accept("+") && !accept("-")) return type;
      parse_right_number(type, left, c, &Parser::parse_product);
      emit(c == '+' ? Operation::add : Operation::subtract, column);
    }
  }

  Type parse_product() {
    const std::size_t left = at_;
    const Type type = parse_unary();
    while (true) {
      const std::size_t column = at_;
      const char c = peek();
      if (!accept("*") && !accept("/")) return type;
      parse_right_number(type, left, c, &Parser::parse_unary);
      emit(c == '*' ? Operation::multiply : Operation::divide, column);
    }
  }

  Type parse_unary() {
    const std::size_t column = at_;
    const bool minus = accept("-");
    const bool exclamation = !minus && text_.substr(at_, 2) != "!=" && accept("!");
    if (!minus && !exclamation) return parse_power();
    const DepthGuard guard(*this);
    const std::size_t operand = at_;
    const Type type = parse_unary();
    if (exclamation) {
      expect(type, Type::condition, operand, "'!' needs parentheses, as in !(z > 3): it is before");
      emit(Operation::logical_not, column);
    } else {
      expect(type, Type::number, operand, "'-' is before");
      emit(Operation::negate, column);
    }
    return type;
  }

  // Binds tighter than unary minus on its left (-x^2 is -(x^2)), and to the right: 2^3^2 is 2^9.
  Type parse_power() {
    const std::size_t left = at_;
    const Type type = parse_primary();
    const std::size_t column = at_;
    if (!accept("^")) return type;
    const DepthGuard guard(*this);
    parse_right_number(type, left, '^', &Parser::parse_unary);
    emit(Operation::power, column);
    return Type::number;
  }

  void parse_right_number(Type left_type, std::size_t left, char symbol,
                          Type (Parser::*parse_operand)()) {
    expect(left_type, Type::number, left, fmt::format("left of '{}' is", symbol));
    const std::size_t right = at_;
    expect((this->*parse_operand)(), Type::number, right, fmt::format("right of '{}' is", symbol));
  }

  Type parse_primary() {
    const std::size_t start = at_;
    const char c = peek();
    if (accept("(")) {
      const DepthGuard guard(*this);
      const Type type = parse_or();
      if (!accept(")")) fail(at_, "expected ')', found " + found());
      return type;
    }
    if (is_digit(c) || (c == '.' && start + 1 < text_.size() && is_digit(text_[start + 1]))) {
      return parse_number();
    }
    if (c == '\'' || c == '"') {
      emit(Operation::text, start).name = quoted(c);
      return Type::text;
    }
    if (c == '`') {
      return variable(quoted(c), start);
    }
    if (starts_name(c)) return parse_name();
    fail(start, "expected a number, a name, a text in quotes or '(', found " + found());
  }

  Type parse_number() {
    Instruction& instruction = emit(Operation::number, at_);
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), instruction.number);
    if (error != std::errc{}) fail(at_, "expected a number that fits a double");
    const std::size_t start = at_;
    at_ = static_cast<std::size_t>(end - text_.data());
    if (at_ < text_.size() && continues_name(text_[at_])) {
      fail(start,
           "expected a number, found '" + printable(text_.substr(start, at_ + 1 - start)) + "'");
    }
    skip_blanks();
    return Type::number;
  }

  Type parse_name() {
    const std::size_t start = at_;
    const std::string name(word());
    at_ += name.size();
    skip_blanks();
    if (accept("(")) return parse_call(name, start);
    for (const std::string_view keyword : {"and", "or", "not"}) {
      if (name == keyword) {
        fail(start, fmt::format("expected a number, a name, a text in quotes or '(', found '{}'",
                                keyword));
      }
    }
    const Type type = variable(name, start);
    return name == "species" ? Type::text : type;
  }

  Type variable(const std::string& name, std::size_t start) {
    Instruction& instruction = emit(Operation::variable, start);
    instruction.name = name;
    if (!check_) return Type::unchecked;
    check_(instruction);
    return Type::number;
  }

  Type parse_call(const std::string& name, std::size_t start) {
    const Function* function = nullptr;
    std::vector<std::string> names;
    for (const Function& f : functions) {
      if (f.name == name) function = &f;
      names.emplace_back(f.name);
    }
    if (function == nullptr) fail(start, unknown_name("function", name, names).what());
    const DepthGuard guard(*this);
    int arguments = 0;
    do {
      const std::size_t argument = at_;
      expect(parse_or(), Type::number, argument, "the argument of " + name + " is");
      ++arguments;
      // min and max of several take them two at a time.
      if (arity(function->operation) == 1 || arguments > 1) emit(function->operation, start);
    } while (accept(","));
    if (!accept(")")) fail(at_, "expected ',' or ')', found " + found());
    if (arity(function->operation) == 1 && arguments != 1) {
      fail(start, name + " takes one argument");
    }
    if (arity(function->operation) == 2 && arguments < 2) {
      fail(start, name + " takes two arguments or more");
    }
    return Type::number;
  }

  /// The name at the current place; LAMMPS' c_stress[1] is one name.
  std::string_view word() const {
    std::size_t end = at_;
    while (end < text_.size() && continues_name(text_[end])) ++end;
    if (end < text_.size() && end > at_ && text_[end] == '[') {
      std::size_t digit = end + 1;
      while (digit < text_.size() && is_digit(text_[digit])) ++digit;
      if (digit > end + 1 && digit < text_.size() && text_[digit] == ']') end = digit + 1;
    }
    return text_.substr(at_, end - at_);
  }

  std::string quoted(char quote) {
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) {
      fail(at_, fmt::format("expected a closing {} for the one here", quote));
    }
    std::string content(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    skip_blanks();
    return content;
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  bool accept(std::string_view symbol) {
    if (text_.substr(at_, symbol.size()) != symbol) return false;
    at_ += symbol.size();
    skip_blanks();
    return true;
  }

  bool accept_word(std::string_view keyword) { return word() == keyword && accept(keyword); }

  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  Instruction& emit(Operation operation, std::size_t at) {
    return program_.emplace_back(Instruction{operation, 0, {}, at + 1});
  }

  void expect(Type type, Type wanted, std::size_t at, std::string_view where) const {
    if (type == wanted || (type == Type::unchecked && wanted == Type::number)) return;
    fail(at, fmt::format("{} {}; expected {}", where, name_of(type), name_of(wanted)));
  }

  std::string found() const {
    if (at_ >= text_.size()) return "the end";
    const std::string_view w = word();
    return "'" + printable(w.empty() ? text_.substr(at_, 1) : w) + "'";
  }

  [[noreturn]] void fail(std::size_t at, std::string_view what) const {
    throw_at_column(text_, at + 1, what);
  }

  struct DepthGuard {
    explicit DepthGuard(Parser& p) : parser(p) {
      if (++parser.depth_ > max_depth) {
        parser.fail(parser.at_, fmt::format("nested more than {} deep", max_depth));
      }
    }
    ~DepthGuard() { --parser.depth_; }
    DepthGuard(const DepthGuard&) = delete;
    DepthGuard& operator=(const DepthGuard&) = delete;
    Parser& parser;
  };

  std::string_view text_;
  const CheckVariable& check_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Instruction> program_;
};

}  // namespace

int arity(Operation operation) {
  if (operation <= Operation::text) return 0;
  return operation <= Operation::exp ? 1 : 2;
}

std::vector<Instruction> parse_expression(std::string_view expression, const CheckVariable& check) {
  return Parser(expression, check).parse();
}

void throw_at_column(std::string_view expression, std::size_t column, std::string_view what) {
  throw Error(fmt::format("expression \"{}\", column {}: {}", printable(expression), column, what));
}

}  // namespace motes
