// Reads the elements of H5MD's particle groups, frame by frame.
#include "io/h5md.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "io/bytes.h"
#include "io/hdf5_columns.h"
#include "io/text.h"
#include "io/type_names.h"
#include "particles/elements.h"

namespace motes {

namespace {

/// A quantity: a dataset that holds for all frames, or a group whose dataset `value` has a row a
/// frame.
struct H5mdElement {
  std::string path;     ///< of the element: "particles/all/position"
  std::string dataset;  ///< of its values
  bool per_frame = false;
  std::uint64_t num_frames = 1;
  std::vector<std::uint64_t> shape;  ///< of one frame
};

struct ParticleGroup {
  std::string name;
  std::string path;
  H5mdElement position;
  std::uint64_t size() const { return position.shape[0]; }
};

std::optional<H5mdElement> find_element(const Hdf5File& file, const std::string& path) {
  H5mdElement element{path, path, false, 1, {}};
  if (file.has_dataset(path + "/value")) {
    element.dataset = path + "/value";
    element.per_frame = true;
  } else if (!file.has_dataset(path)) {
    return std::nullopt;
  }
  element.shape = file.shape(element.dataset);
  if (element.per_frame) {
    if (element.shape.empty()) file.fail(element.dataset, "is one value; expected a row a frame");
    element.num_frames = element.shape[0];
    element.shape.erase(element.shape.begin());
  }
  return element;
}

bool is_number(const Hdf5File& file, const H5mdElement& element) {
  const Hdf5Type type = file.type(element.dataset);
  return type != Hdf5Type::text && type != Hdf5Type::other;
}

/// Step numbers of an element's frames, or nothing where the file does not list them.
std::optional<std::vector<std::int64_t>> steps(const Hdf5File& file, const H5mdElement& element) {
  const std::string dataset = element.path + "/step";
  if (!element.per_frame || !file.has_dataset(dataset) ||
      file.shape(dataset) != std::vector<std::uint64_t>{element.num_frames}) {
    return std::nullopt;
  }
  return file.read<std::int64_t>(dataset);
}

/// The frame of `element` at the moment of frame `frame` of `position`. Elements may be stored at
/// other intervals than positions; nothing if there is no such frame.
std::optional<std::uint64_t> matching_frame(const Hdf5File& file, const H5mdElement& element,
                                            const H5mdElement& position, std::uint64_t frame) {
  if (!element.per_frame) return 0;
  if (element.num_frames == position.num_frames) return frame;
  const auto own = steps(file, element), wanted = steps(file, position);
  if (!own || !wanted) return std::nullopt;
  const auto it = std::find(own->begin(), own->end(), (*wanted)[frame]);
  if (it == own->end()) return std::nullopt;
  return static_cast<std::uint64_t>(it - own->begin());
}

template <class T>
std::vector<T> read_values(const Hdf5File& file, const H5mdElement& element, std::uint64_t frame) {
  std::uint64_t count = 1;
  for (const std::uint64_t n : element.shape) count *= n;
  std::vector<T> values(count);
  if (count == 0) return values;
  const std::uint64_t rows = element.per_frame || element.shape.empty() ? 1 : element.shape[0];
  file.read_rows(element.dataset, element.per_frame ? frame : 0, rows, values.data());
  return values;
}

/// Values of the element at `frame` of the group's positions, if it has some then.
template <class T>
std::optional<std::vector<T>> read_if_there(const Hdf5File& file, const ParticleGroup& group,
                                            std::string_view name, std::uint64_t frame) {
  const auto element = find_element(file, fmt::format("{}/{}", group.path, name));
  if (!element || !is_number(file, *element)) return std::nullopt;
  const auto matching = matching_frame(file, *element, group.position, frame);
  if (!matching) return std::nullopt;
  return read_values<T>(file, *element, *matching);
}

std::string unit_of(const Hdf5File& file, const H5mdElement& element) {
  const std::string unit = file.text(element.dataset, "unit");
  return unit.empty() ? file.text(element.path, "unit") : unit;
}

/// What turns a length of that unit into angstrom; nothing for units that are kept.
std::optional<double> angstrom_per(const std::string& unit) {
  if (unit == "nm" || unit == "nanometer") return 10;
  if (unit == "pm") return 0.01;
  if (unit == "Angstrom" || unit == "angstrom" || unit == "A" || unit == "\xc3\x85" ||
      unit == "\xe2\x84\xab") {
    return 1;
  }
  return std::nullopt;
}

/// What turns a velocity of the group into angstrom per unit of time, where positions are converted
/// too: the factor of the length in its own unit ("nm ps-1", "Angstrom/fs"), or that of positions
/// where it has no unit. 1 where nothing is converted.
double velocity_factor(const Hdf5File& file, const ParticleGroup& group,
                       const H5mdElement& velocity) {
  const auto of_positions = angstrom_per(unit_of(file, group.position));
  std::string unit = unit_of(file, velocity);
  if (!of_positions || unit.empty()) return of_positions.value_or(1);
  std::replace(unit.begin(), unit.end(), '/', ' ');
  for (std::string_view symbol : split_tokens(unit)) {
    if (symbol.ends_with("+1")) symbol.remove_suffix(2);
    if (const auto factor = angstrom_per(std::string(symbol))) return *factor;
  }
  return 1;
}

std::vector<ParticleGroup> find_groups(const Hdf5File& file) {
  std::vector<ParticleGroup> groups;
  if (!file.has_group("particles")) return groups;
  for (const std::string& name : file.members("particles")) {
    const std::string path = "particles/" + name;
    const auto position = find_element(file, path + "/position");
    if (!position) continue;
    if (!is_number(file, *position) || position->shape.size() != 2 || position->shape[1] != 3) {
      file.fail(position->dataset, "is no table of positions; expected frames x n x 3 numbers");
    }
    if (!groups.empty() && groups.front().position.num_frames != position->num_frames) {
      file.fail(position->dataset,
                fmt::format("has {} frames; expected {}, as in particles/{}", position->num_frames,
                            groups.front().position.num_frames, groups.front().name));
    }
    groups.push_back({name, path, *position});
  }
  return groups;
}

class H5mdTrajectory : public Trajectory {
 public:
  H5mdTrajectory(Hdf5File file, const ReadOptions& options)
      : file_(std::move(file)), options_(options), groups_(find_groups(file_)) {
    if (groups_.empty()) {
      throw Error(file_.path(), "has no positions; expected particles/GROUP/position (H5MD)");
    }
  }

  std::string_view format() const override { return "H5MD"; }
  std::size_t num_frames() override { return groups_.front().position.num_frames; }
  ParticleSet read_frame(std::size_t frame) override;

 private:
  void read_positions(std::uint64_t frame, ParticleSet& particles) const;
  void read_cell_and_time(std::uint64_t frame, ParticleSet& particles) const;
  void read_all_species(std::uint64_t frame, ParticleSet& particles) const;
  std::set<std::int64_t> read_species(const ParticleGroup& group, std::uint64_t frame,
                                      ParticleSet& particles) const;
  std::set<std::int64_t> distinct_species(const ParticleGroup& group,
                                          const std::vector<double>& numbers) const;
  std::map<std::int64_t, std::string> species_names(const ParticleGroup& group,
                                                    const std::set<std::int64_t>& distinct) const;
  void read_ids(std::uint64_t frame, ParticleSet& particles) const;
  void read_properties(std::uint64_t frame, ParticleSet& particles) const;

  Hdf5File file_;
  ReadOptions options_;
  std::vector<ParticleGroup> groups_;
};

/// Removes the particles that are only padding: H5MD gives them the identifier -1.
void remove_padding(ParticleSet& particles) {
  if (std::find(particles.ids.begin(), particles.ids.end(), -1) == particles.ids.end()) return;
  const std::vector<std::int64_t> ids = particles.ids;
  const auto compact = [&](auto& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (ids[i] != -1) values[kept++] = values[i];
    }
    values.resize(kept);
  };
  compact(particles.x);
  compact(particles.y);
  compact(particles.z);
  compact(particles.species);
  compact(particles.ids);
  for (Property& property : particles.properties) compact(property.values);
}

ParticleSet H5mdTrajectory::read_frame(std::size_t frame) {
  if (frame >= num_frames()) throw_no_such_frame(file_.path(), frame, num_frames());
  ParticleSet particles;
  read_positions(frame, particles);
  read_cell_and_time(frame, particles);
  read_all_species(frame, particles);
  read_ids(frame, particles);
  read_properties(frame, particles);
  remove_padding(particles);
  return particles;
}

void H5mdTrajectory::read_positions(std::uint64_t frame, ParticleSet& particles) const {
  const std::string unit = unit_of(file_, groups_.front().position);
  const auto scale = angstrom_per(unit);
  particles.length_unit = scale ? "angstrom" : unit.empty() ? "unknown" : unit;
  std::vector<double> x, y, z;
  for (const ParticleGroup& group : groups_) {
    const double factor = angstrom_per(unit_of(file_, group.position)).value_or(1);
    const std::vector<double> values = read_values<double>(file_, group.position, frame);
    for (std::size_t i = 0; i < values.size(); i += 3) {
      x.push_back(values[i] * factor);
      y.push_back(values[i + 1] * factor);
      z.push_back(values[i + 2] * factor);
    }
  }
  set_positions(particles, x, y, z);
}

void H5mdTrajectory::read_cell_and_time(std::uint64_t frame, ParticleSet& particles) const {
  const ParticleGroup& group = groups_.front();
  const std::string time = group.position.path + "/time";
  if (group.position.per_frame && file_.has_dataset(time)) {
    const std::vector<double> times = file_.read<double>(time);
    // One number is the interval between frames.
    const bool interval = file_.shape(time).empty();
    if (interval) {
      particles.time =
          file_.number(time, "offset").value_or(0) + times[0] * static_cast<double>(frame);
    } else if (frame < times.size()) {
      particles.time = times[frame];
    }
  }

  const auto edges = read_if_there<double>(file_, group, "box/edges", frame);
  if (!edges || (edges->size() != 3 && edges->size() != 9) ||
      !std::all_of(edges->begin(), edges->end(), [](double e) { return std::isfinite(e); })) {
    return;
  }
  // A box without a unit of its own has that of the positions.
  const std::string own_unit = unit_of(file_, *find_element(file_, group.path + "/box/edges"));
  const std::string unit = own_unit.empty() ? unit_of(file_, group.position) : own_unit;
  const double factor = angstrom_per(unit).value_or(1);
  Cell cell;
  for (int v = 0; v < 3; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(edges->size() == 9 ? 3 * v + axis : v);
      const bool zero = edges->size() == 3 && v != axis;
      cell.vectors[static_cast<std::size_t>(v)][axis] = zero ? 0 : factor * (*edges)[i];
    }
  }
  const auto offset = read_if_there<double>(file_, group, "box/offset", frame);
  if (offset && offset->size() == 3) {
    cell.origin = {(*offset)[0] * factor, (*offset)[1] * factor, (*offset)[2] * factor};
  }
  const std::vector<std::string> boundary = file_.texts(group.path + "/box", "boundary");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell.periodic[axis] = axis >= boundary.size() || boundary[axis] != "none";
  }
  // Programs without a cell write one of zeros.
  if (dot(cell.vectors[0], cross(cell.vectors[1], cell.vectors[2])) != 0) particles.cell = cell;
}

std::set<std::int64_t> H5mdTrajectory::distinct_species(const ParticleGroup& group,
                                                        const std::vector<double>& numbers) const {
  std::set<std::int64_t> distinct;
  for (const double n : numbers) {
    if (!(std::abs(n) < 65536)) {
      file_.fail(group.path + "/species", "is out of range; expected small numbers");
    }
    distinct.insert(std::llround(n));
    if (distinct.size() > 4096) {
      file_.fail(group.path + "/species", "has more than 4096 distinct numbers; expected species");
    }
  }
  return distinct;
}

std::map<std::int64_t, std::string> H5mdTrajectory::species_names(
    const ParticleGroup& group, const std::set<std::int64_t>& distinct) const {
  const std::string dataset = find_element(file_, group.path + "/species")->dataset;
  std::map<std::int64_t, std::string> names = file_.enumeration(dataset);
  const std::vector<std::string> listed = file_.texts(dataset, "names");
  for (std::size_t i = 0; i < listed.size(); ++i) {
    names.emplace(static_cast<std::int64_t>(i), listed[i]);
  }
  // Labels count from 0 or 1; numbers with gaps, all of which are elements, are atomic numbers.
  const bool atomic_numbers = names.empty() && !distinct.empty() &&
                              *distinct.rbegin() > static_cast<std::int64_t>(distinct.size()) &&
                              std::all_of(distinct.begin(), distinct.end(), [](std::int64_t n) {
                                return element_by_number(static_cast<int>(n)) != nullptr;
                              });
  bool guessed = false;
  for (const std::int64_t n : distinct) {
    if (const auto it = options_.types.find(static_cast<int>(n)); it != options_.types.end()) {
      names[n] = it->second;
    } else if (!names.contains(n)) {
      guessed = atomic_numbers;
      names[n] = atomic_numbers ? std::string(element_by_number(static_cast<int>(n))->symbol)
                                : std::to_string(n);
    }
  }
  if (guessed && options_.warnings != nullptr) {
    options_.warnings->add("numbers of species are taken for atomic numbers");
  }
  return names;
}

/// Appends the species of the group's particles, and gives their numbers in the file.
std::set<std::int64_t> H5mdTrajectory::read_species(const ParticleGroup& group, std::uint64_t frame,
                                                    ParticleSet& particles) const {
  const auto numbers = read_if_there<double>(file_, group, "species", frame);
  if (!numbers) {
    // One group without species says nothing about its particles; several differ by group.
    if (groups_.size() > 1) {
      particles.species.resize(particles.species.size() + group.size(),
                               particles.species_index(group.name));
    }
    return {};
  }
  if (numbers->size() != group.size()) {
    file_.fail(group.path + "/species",
               fmt::format("has {} values a frame; expected {}", numbers->size(), group.size()));
  }
  std::set<std::int64_t> distinct = distinct_species(group, *numbers);
  std::map<std::int64_t, std::uint16_t> indices;
  for (const auto& [number, name] : species_names(group, distinct)) {
    indices[number] = particles.species_index(name);
  }
  for (const double n : *numbers) particles.species.push_back(indices.at(std::llround(n)));
  return distinct;
}

void H5mdTrajectory::read_all_species(std::uint64_t frame, ParticleSet& particles) const {
  std::set<std::int64_t> numbers;
  for (const ParticleGroup& group : groups_) numbers.merge(read_species(group, frame, particles));
  std::vector<std::string> types;
  types.reserve(numbers.size());
  for (const std::int64_t number : numbers) types.push_back(std::to_string(number));
  warn_of_absent_types(file_.path(), types, options_);
}

void H5mdTrajectory::read_ids(std::uint64_t frame, ParticleSet& particles) const {
  for (const ParticleGroup& group : groups_) {
    const auto ids = read_if_there<std::int64_t>(file_, group, "id", frame);
    if (!ids || ids->size() != group.size()) {
      particles.ids.clear();
      return;
    }
    particles.ids.insert(particles.ids.end(), ids->begin(), ids->end());
  }
}

void H5mdTrajectory::read_properties(std::uint64_t frame, ParticleSet& particles) const {
  std::map<std::string, std::vector<float>> properties;
  const auto add = [&](const std::string& name, std::size_t first, std::size_t count,
                       const float* values, std::size_t stride) {
    auto& column = properties[name];
    column.resize(particles.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < count; ++i) column[first + i] = values[i * stride];
  };
  std::vector<std::string> imprecise;
  std::size_t first = 0;
  for (const ParticleGroup& group : groups_) {
    for (const std::string& name : file_.members(group.path)) {
      if (name == "position" || name == "species" || name == "id" || name == "box") continue;
      auto values = read_if_there<float>(file_, group, name, frame);
      if (!values) continue;
      const auto element = find_element(file_, fmt::format("{}/{}", group.path, name));
      if (file_.type(element->dataset) == Hdf5Type::integer && may_lack_digits(*values)) {
        imprecise.push_back(element->path);
        continue;
      }
      if (name == "velocity") {
        const auto factor = static_cast<float>(velocity_factor(file_, group, *element));
        for (float& value : *values) value *= factor;
      }
      if (values->size() == group.size()) {
        add(name, first, group.size(), values->data(), 1);
      } else if (values->size() == 3 * group.size()) {
        for (std::size_t k = 0; k < 3; ++k) {
          add((name == "velocity" ? "v" : name + "_") + "xyz"[k], first, group.size(),
              values->data() + k, 3);
        }
      }
    }
    first += group.size();
  }
  warn_of_left_out(imprecise, lack_of_digits, options_);
  for (auto& [name, values] : properties) particles.properties.push_back({name, std::move(values)});
}

}  // namespace

bool is_h5md(const Hdf5File& file) { return file.has_group("h5md"); }

std::unique_ptr<Trajectory> open_h5md(Hdf5File file, const ReadOptions& options) {
  return std::make_unique<H5mdTrajectory>(std::move(file), options);
}

}  // namespace motes
