// The directions in which linear systems with one operator look for their solutions.
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "euler/state.hpp"

namespace alphadot {

/// Directions z of a linear system and their images w, what a unit of z adds to the defect, made orthonormal:
/// the generalised conjugate residual form of GMRES (Eisenstat, Elman & Schultz 1983). Several systems share
/// the directions. These stay as they come, in an upper triangle is kept how their images are made of the
/// orthonormal ones, W = Q R, so that only the images pass through the processor. Kept in single precision,
/// 40 bytes a cell and direction; sums are in double. Over the complex numbers, Scalar = std::complex<Real>,
/// a vector is the real parts of all cells and then the imaginary ones.
template <class Scalar>
class KrylovBasis {
 public:
  /// Sums numbers over all ranks, in place.
  using Sum = std::function<void(std::vector<Real>&)>;

  /// What may widen the space. The image is overwritten.
  struct Candidate {
    std::span<const Primitive<Real>> direction;
    std::span<Primitive<Real>> image;
    std::vector<Scalar> functionals;  ///< linear ones, of the direction
  };
  /// One system on its way.
  struct System {
    std::span<Primitive<Real>> defect;
    std::vector<Scalar> functionals;   ///< of the solution
    std::vector<Scalar> coefficients;  ///< of the orthonormal images in the defect so far
    Real norm;                         ///< of the defect
  };

  /// For vectors of `cells` on this rank; wants no more than `capacity` directions.
  KrylovBasis(std::size_t cells, int capacity, Sum sum);

  void clear() { directions_.clear(); }
  int size() const { return static_cast<int>(directions_.size()); }
  bool is_full() const { return size() >= capacity_; }

  /// Adds all candidates but those whose image lies in the span of the others. Collective: one all-reduce,
  /// and another for an image that lies close to that span.
  void add(std::span<const Candidate> candidates);

  /// Makes every defect as small as the images can that the system has not yet met, and moves its functionals
  /// along. The solution follows by move(). Collective: one all-reduce.
  void reduce(std::span<System> systems) const;

  /// Adds to the solution what belongs to the coefficients of a system.
  void move(std::span<Primitive<Real>> solution, std::span<const Scalar> coefficients) const;

  std::size_t bytes() const { return directions_.size() * cells_ * 2 * sizeof(Five<float>) * parts; }

 private:
  static constexpr std::size_t parts = std::is_same_v<Scalar, Real> ? 1 : 2;
  struct Direction {
    std::vector<float> direction, image;  // [5 parts cells]
    std::vector<Scalar> column;           // of R, down to the diagonal, which is real
    std::vector<Scalar> functionals;      // of the direction whose image is the orthonormal one
  };
  void keep(const Candidate& candidate, std::vector<Scalar> column);
  void sum(std::vector<Scalar>& numbers) const;

  std::size_t cells_;
  int capacity_;
  Sum sum_;
  std::vector<Direction> directions_;
};

extern template class KrylovBasis<Real>;
extern template class KrylovBasis<std::complex<Real>>;

/// Square of the Euclidean norm of this rank's part.
Real square(std::span<const Primitive<Real>> vector);

}  // namespace alphadot
