// The directions in which linear systems with one operator look for their solutions.
#pragma once

#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "euler/state.hpp"

namespace alphadot {

/// Directions z with orthonormal images w = A z of a linear operator: the generalised conjugate residual form
/// of GMRES (Eisenstat, Elman & Schultz 1983). Several right-hand sides share the directions.
/// Kept in single precision, 40 bytes a cell and direction; sums are in double.
class SearchSpace {
 public:
  /// For vectors of `cells` on this rank; holds up to `capacity` directions.
  SearchSpace(std::size_t cells, int capacity, const Communicator& comm);

  void clear() { directions_.clear(); }
  int size() const { return static_cast<int>(directions_.size()); }
  bool is_full() const { return size() >= capacity_; }

  /// Adds a direction, its image and linear functionals of it; the first two are overwritten. Leaves out one
  /// whose image lies in the span of the others. Collective: one all-reduce, two where the image lies close
  /// to that span.
  void add(std::span<Primitive<Real>> direction, std::span<Primitive<Real>> image,
           std::vector<Real> functionals);

  /// Moves `solution` by directions from number `first` on so that what is left of `defect` = b - A solution
  /// becomes the smallest, and `functionals` with it. Returns the square of the defect's norm. Collective:
  /// one all-reduce.
  Real reduce(int first, std::span<Primitive<Real>> defect, std::span<Primitive<Real>> solution,
              std::span<Real> functionals) const;

  std::size_t bytes() const { return directions_.size() * cells_ * 2 * sizeof(Five<float>); }

 private:
  struct Direction {
    std::vector<Five<float>> direction, image;  // [cells]
    std::vector<Real> functionals;
  };
  /// Of a vector with the images from number `first` on, and at the end with itself.
  std::vector<Real> products(std::size_t first, std::span<const Primitive<Real>> vector) const;

  const Communicator& comm_;
  std::size_t cells_;
  int capacity_;
  std::vector<Direction> directions_;
};

/// Square of the Euclidean norm of this rank's part.
Real square(std::span<const Primitive<Real>> vector);

}  // namespace alphadot
