// Reduction of a lattice's edges (Selling), and the way down to the nearest image.
#include "particles/minimum_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace motes {
namespace {

double square(const Vector3d& v) { return dot(v, v); }

/// Whether `edge` adds a dimension to what `edges`, one or two, span: not if nothing but rounding
/// of it sticks out.
bool is_independent(const Vector3d& edge, const std::vector<Vector3d>& edges) {
  constexpr double rounding = 1e-9;
  if (!(square(edge) > 0) || !std::isfinite(square(edge))) return false;
  const Vector3d unit = normalize(edge);
  if (edges.empty()) return true;
  const Vector3d across = cross(normalize(edges[0]), unit);
  if (!(length(across) > rounding)) return false;
  if (edges.size() == 1) return true;
  return std::abs(dot(normalize(edges[1]), across)) > rounding;
}

/// Takes whole multiples of the edges off each other for as long as that makes one shorter.
void shorten(std::vector<Vector3d>& edges) {
  for (bool again = true; again;) {
    again = false;
    for (Vector3d& edge : edges) {
      for (const Vector3d& other : edges) {
        if (&edge == &other) continue;
        const double quotient = dot(edge, other) / square(other);
        if (!(std::abs(quotient) > 0.5 + 1e-12)) continue;
        edge = edge - std::round(quotient) * other;
        again = true;
      }
    }
  }
}

/// Makes the edges, with minus their sum, include no acute angle (Selling 1874; Conway & Sloane
/// 1992, "Low-dimensional lattices VI"). Each step shortens the vectors' sum of squares.
void make_obtuse(std::vector<Vector3d>& edges) {
  std::vector<Vector3d> all = edges;
  Vector3d sum;
  for (const Vector3d& edge : edges) sum = sum + edge;
  all.push_back(-sum);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < all.size() && !again; ++i) {
      for (std::size_t j = i + 1; j < all.size() && !again; ++j) {
        if (!(dot(all[i], all[j]) > 1e-12 * (square(all[i]) + square(all[j])))) continue;
        // In three dimensions the other two take the edge that turns round, in two the only other
        // one takes it twice.
        const Vector3d turned = all[i];
        const double share = all.size() == 4 ? 1 : 2;
        for (std::size_t k = 0; k < all.size(); ++k) {
          if (k != i && k != j) all[k] = all[k] + share * turned;
        }
        all[i] = -turned;
        again = true;
      }
    }
  }
  std::copy_n(all.begin(), edges.size(), edges.begin());
}

}  // namespace

MinimumImage::MinimumImage(const std::optional<Cell>& cell) {
  if (!cell) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vector3d& edge = cell->vectors[axis];
    if (cell->periodic[axis] && is_independent(edge, edges_)) edges_.push_back(edge);
  }
  if (edges_.empty()) return;
  shorten(edges_);
  if (edges_.size() > 1) make_obtuse(edges_);
  // The faces of the Voronoi region of edges without acute angles lie towards all their partial
  // sums (Conway & Sloane).
  for (unsigned which = 1; which < 1u << edges_.size(); ++which) {
    Face face;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if ((which >> i & 1) != 0) face.to = face.to + edges_[i];
    }
    face.inverse_square = 1 / square(face.to);
    faces_.push_back(face);
  }
}

Vector3d MinimumImage::operator()(Vector3d v) const {
  // Each step leads to an image that is nearer; where there is none beyond any face, it is the
  // nearest (Sommer, Feder & Shalvi 2009).
  for (bool again = true; again;) {
    again = false;
    for (const Face& face : faces_) {
      const double quotient = dot(v, face.to) * face.inverse_square;
      if (!(std::abs(quotient) > 0.5 + 1e-12) || !std::isfinite(quotient)) continue;
      v = v - std::round(quotient) * face.to;
      again = true;
    }
  }
  return v;
}

}  // namespace motes
