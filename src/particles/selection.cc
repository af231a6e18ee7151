// Runs the program of a selection expression over the particles, a block at a time, in parallel.
#include "particles/selection.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "particles/selection_parser.h"

namespace motes {
namespace {

// Particles that one instruction works on before the next follows: values stay in the cache.
constexpr std::size_t block_size = 1024;

/// What an instruction pushes: a constant, or each particle's value.
struct Operand {
  enum class Source { constant, x, y, z, id, index, species, property } source = Source::constant;
  double constant = 0;
  const float* values = nullptr;  // of a property
};

std::vector<std::string> known_names(const ParticleSet& particles) {
  std::vector<std::string> names{"x", "y", "z", "index"};
  if (!particles.ids.empty()) names.emplace_back("id");
  if (!particles.species.empty()) names.emplace_back("species");
  for (const Property& p : particles.properties) names.push_back(p.name);
  return names;
}

Operand bind_variable(const ParticleSet& particles, std::string_view expression,
                      const Instruction& instruction) {
  using Source = Operand::Source;
  const std::string& name = instruction.name;
  if (name == "x") return {Source::x};
  if (name == "y") return {Source::y};
  if (name == "z") return {Source::z};
  if (name == "index") return {Source::index};
  if (name == "id" && !particles.ids.empty()) return {Source::id};
  if (name == "species" && !particles.species.empty()) return {Source::species};
  if (const Property* property = particles.find_property(name)) {
    return {Source::property, 0, property->values.data()};
  }
  const auto& species = particles.species_names;
  const bool is_species = std::find(species.begin(), species.end(), name) != species.end();
  throw_at_column(expression, instruction.column,
                  is_species
                      ? fmt::format("unknown property '{0}'; text is written in quotes, as in "
                                    "species == '{0}'",
                                    printable(name))
                      : unknown_name("property", name, known_names(particles)).what());
}

/// A text's value is the index of the species of that name, so that texts compare as numbers; texts
/// that are no species get a negative number each.
Operand bind_text(const ParticleSet& particles, const std::string& text,
                  std::vector<std::string>& other_texts) {
  const auto index_in = [&text](const std::vector<std::string>& names) {
    return static_cast<double>(std::find(names.begin(), names.end(), text) - names.begin());
  };
  const double species = index_in(particles.species_names);
  if (species < static_cast<double>(particles.species_names.size())) {
    return {Operand::Source::constant, species};
  }
  const double other = index_in(other_texts);
  if (other == static_cast<double>(other_texts.size())) other_texts.push_back(text);
  return {Operand::Source::constant, -1 - other};
}

class Program {
 public:
  Program(const ParticleSet& particles, std::string_view expression)
      : particles_(particles),
        instructions_(parse_expression(expression, [&](const Instruction& variable) {
          bind_variable(particles, expression, variable);
        })) {
    std::vector<std::string> other_texts;
    std::size_t height = 0;
    for (const Instruction& instruction : instructions_) {
      height = height + 1 - static_cast<std::size_t>(arity(instruction.operation));
      max_height_ = std::max(max_height_, height);
      Operand operand;
      if (instruction.operation == Operation::number) operand.constant = instruction.number;
      if (instruction.operation == Operation::variable) {
        operand = bind_variable(particles, expression, instruction);
      }
      if (instruction.operation == Operation::text) {
        operand = bind_text(particles, instruction.name, other_texts);
      }
      operands_.push_back(operand);
    }
  }

  /// Doubles that run() needs to work in.
  std::size_t workspace_size() const { return max_height_ * block_size; }

  /// The values of `count` particles from `first`; they are in the first block of `workspace`.
  void run(std::size_t first, std::size_t count, double* workspace) const {
    double* top = workspace;  // one past the uppermost value
    for (std::size_t k = 0; k < instructions_.size(); ++k) {
      const Operation operation = instructions_[k].operation;
      switch (arity(operation)) {
        case 0:
          load(operands_[k], first, count, top);
          top += block_size;
          break;
        case 1:
          apply_unary(operation, count, top - block_size);
          break;
        default:
          top -= block_size;
          apply_binary(operation, count, top - block_size, top);
      }
    }
  }

 private:
  void load(const Operand& operand, std::size_t first, std::size_t count, double* out) const;
  static void apply_unary(Operation operation, std::size_t count, double* a);
  static void apply_binary(Operation operation, std::size_t count, double* a, const double* b);

  const ParticleSet& particles_;
  std::vector<Instruction> instructions_;
  std::vector<Operand> operands_;  // one an instruction
  std::size_t max_height_ = 0;
};

void Program::load(const Operand& operand, std::size_t first, std::size_t count,
                   double* out) const {
  const auto coordinates = [&](const std::vector<float>& values, double origin) {
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = origin + static_cast<double>(values[first + i]);
    }
  };
  switch (operand.source) {
    case Operand::Source::constant:
      std::fill_n(out, count, operand.constant);
      break;
    case Operand::Source::x:
      coordinates(particles_.x, particles_.origin.x);
      break;
    case Operand::Source::y:
      coordinates(particles_.y, particles_.origin.y);
      break;
    case Operand::Source::z:
      coordinates(particles_.z, particles_.origin.z);
      break;
    case Operand::Source::id:
      for (std::size_t i = 0; i < count; ++i) {
        out[i] = static_cast<double>(particles_.ids[first + i]);
      }
      break;
    case Operand::Source::index:
      for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(first + i);
      break;
    case Operand::Source::species:
      std::copy_n(particles_.species.begin() + static_cast<std::ptrdiff_t>(first), count, out);
      break;
    case Operand::Source::property:
      std::copy_n(operand.values + first, count, out);
      break;
  }
}

template <class F>
void for_each_value(std::size_t count, double* a, F&& function) {
  for (std::size_t i = 0; i < count; ++i) a[i] = function(a[i]);
}

template <class F>
void for_each_pair(std::size_t count, double* a, const double* b, F&& function) {
  for (std::size_t i = 0; i < count; ++i) a[i] = function(a[i], b[i]);
}

void Program::apply_unary(Operation operation, std::size_t count, double* a) {
  switch (operation) {
    case Operation::negate:
      return for_each_value(count, a, [](double v) { return -v; });
    case Operation::logical_not:
      return for_each_value(count, a, [](double v) { return v == 0 ? 1.0 : 0.0; });
    case Operation::abs:
      return for_each_value(count, a, [](double v) { return std::abs(v); });
    case Operation::sqrt:
      return for_each_value(count, a, [](double v) { return std::sqrt(v); });
    case Operation::log10:
      return for_each_value(count, a, [](double v) { return std::log10(v); });
    default:
      return for_each_value(count, a, [](double v) { return std::exp(v); });
  }
}

void Program::apply_binary(Operation operation, std::size_t count, double* a, const double* b) {
  const auto apply = [=](auto function) { for_each_pair(count, a, b, function); };
  switch (operation) {
    case Operation::add:
      return apply([](double p, double q) { return p + q; });
    case Operation::subtract:
      return apply([](double p, double q) { return p - q; });
    case Operation::multiply:
      return apply([](double p, double q) { return p * q; });
    case Operation::divide:
      return apply([](double p, double q) { return p / q; });
    case Operation::power:  // mostly squares, for which pow() is slow
      return apply([](double p, double q) { return q == 2 ? p * p : std::pow(p, q); });
    case Operation::min:
      return apply([](double p, double q) { return q < p ? q : p; });
    case Operation::max:
      return apply([](double p, double q) { return p < q ? q : p; });
    case Operation::less:
      return apply([](double p, double q) { return p < q ? 1.0 : 0.0; });
    case Operation::less_equal:
      return apply([](double p, double q) { return p <= q ? 1.0 : 0.0; });
    case Operation::greater:
      return apply([](double p, double q) { return p > q ? 1.0 : 0.0; });
    case Operation::greater_equal:
      return apply([](double p, double q) { return p >= q ? 1.0 : 0.0; });
    case Operation::equal:
      return apply([](double p, double q) { return p == q ? 1.0 : 0.0; });
    case Operation::not_equal:
      return apply([](double p, double q) { return p != q ? 1.0 : 0.0; });
    case Operation::logical_and:
      return apply([](double p, double q) { return p * q; });
    default:
      return apply([](double p, double q) { return std::max(p, q); });  // logical_or
  }
}

}  // namespace

void check_expression(std::string_view expression) { parse_expression(expression); }

void check_expression(std::string_view expression, const ParticleSet& particles) {
  Program(particles, expression);
}

std::vector<std::string> texts_of(std::string_view expression) {
  std::vector<std::string> texts;
  for (const Instruction& instruction : parse_expression(expression)) {
    if (instruction.operation == Operation::text) texts.push_back(instruction.name);
  }
  return texts;
}

std::vector<std::uint32_t> select_where(const ParticleSet& particles, std::string_view expression) {
  const Program program(particles, expression);

  // Each chunk of blocks gathers its own indices; in order they are the answer.
  constexpr std::size_t chunk_size = 64 * block_size;
  const std::size_t num_chunks = (particles.size() + chunk_size - 1) / chunk_size;
  std::vector<std::vector<std::uint32_t>> selected(num_chunks);
  tbb::enumerable_thread_specific<std::vector<double>> workspaces(
      std::vector<double>(program.workspace_size()));
  tbb::parallel_for(std::size_t{0}, num_chunks, [&](std::size_t chunk) {
    std::vector<double>& workspace = workspaces.local();
    const std::size_t end = std::min(particles.size(), (chunk + 1) * chunk_size);
    for (std::size_t first = chunk * chunk_size; first < end; first += block_size) {
      const std::size_t count = std::min(block_size, end - first);
      program.run(first, count, workspace.data());
      for (std::size_t i = 0; i < count; ++i) {
        if (workspace[i] != 0) selected[chunk].push_back(static_cast<std::uint32_t>(first + i));
      }
    }
  });

  std::vector<std::uint32_t> all;
  for (const auto& part : selected) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace motes
