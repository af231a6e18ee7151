// Kernels: the radial functions that stand for particles.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace motes {

/// phi(q) with q = distance / radius, scaled to a peak of 1. All but the Gaussian and the table
/// fall to zero smoothly where their definition says.
enum class KernelType {
  gaussian,        ///< exp(-q^2 / 2) where q <= support_factor, else 0 (Knoll et al. 2014, Eq. 2)
  cubic_spline,    ///< M4 (Monaghan & Lattanzio 1985), to q = 2: radius is the smoothing length h
  quintic_spline,  ///< M6 (Morris 1996), to q = 3
  wendland_c2,     ///< Wendland (1995) in three dimensions, to q = 2 (Dehnen & Aly 2012; Price et
  wendland_c4,     ///<   al. 2018, section 2.1.5)
  wendland_c6,
  tabulated,  ///< a RadialProfile
};

/// Values at even distances from 0 on. Between them the monotone cubic of Hyman (1983): its slopes
/// are differences of fourth order, limited so that it makes no new maxima; 0 at distance 0, and at
/// the last value if that is 0. Zero behind the last.
struct RadialProfile {
  std::filesystem::path path;  ///< of the file that it is from
  double spacing = 1;          ///< radii
  std::vector<double> values;  ///< two at least
  bool operator==(const RadialProfile&) const = default;
};

/// A kernel's form.
struct KernelShape {
  KernelType type = KernelType::gaussian;
  RadialProfile profile;  ///< of tabulated ones
  bool operator==(const KernelShape&) const = default;
};

/// phi(d) = kernel_scale * weight * shape(d / radius).
struct Kernel {
  double support_factor = 2;  ///< sigma, > 0: of Gaussians alone
  double kernel_scale = 1;    ///< kappa
  KernelShape shape = {};
  bool operator==(const Kernel&) const = default;

  /// Where it ends, in radii.
  double support() const;
  /// Over space, of radius 1 and peak 1 (tabulated: as the table has it), cut off at its support.
  double integral() const;
  /// Along one axis, of radius 1; of a Gaussian that is not cut off. Of a table a third of its
  /// support, which is near enough to choose a view and a step by.
  double standard_deviation() const;
};

/// The shape at distance q >= 0, in radii.
struct RadialValue {
  double value = 0;
  double steepness = 0;  ///< -(d value / d q) / q, which is finite at 0
};

/// `kernel` without kernel_scale; zero beyond its support.
RadialValue evaluate(const Kernel& kernel, double q);

/// Throws Error for an unknown name.
KernelType kernel_type_from_name(std::string_view name);
std::string_view name_of(KernelType type);

/// Reads a text file of two columns, distance and value, in lines of numbers apart by spaces, tabs
/// or a comma; lines that begin with # are comments. Distances that are not even are made so: 1024
/// steps, by the monotone cubic through the points. Throws Error that names file and line.
RadialProfile read_radial_profile(const std::filesystem::path& path);

}  // namespace motes
