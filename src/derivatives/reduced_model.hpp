// The responses of a flow at any frequency, as far as those at some frequencies tell.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "euler/state.hpp"

namespace alphadot {

/// Solutions U of (A + i omega M) U = -b looked for in the span of real fields, the parts of solutions at
/// other frequencies: the combination with the smallest norm |D ((A + i omega M) U + b)|. Sums over all cells
/// are made once for a field; an omega costs a small dense system, and its norm comes with it. Of responses
/// that vary smoothly with omega few fields are enough (rational Krylov space; A. Ruhe, Linear Algebra Appl.
/// 58, 1984, 391). 40 bytes a cell and field, in single precision; 80 a source.
class ReducedModel {
 public:
  /// Sums numbers over all ranks, in place.
  using Sum = std::function<void(std::vector<Real>&)>;
  struct Source {
    std::vector<Primitive<Real>> scaled;  ///< D b, real part and then imaginary one, [2 owned_cells]
    std::vector<Real> functionals;  ///< that come with it, of all ranks; all real parts, then the others
  };
  /// The best combination of some of the fields.
  struct Projection {
    Real norm;                               ///< of what it leaves
    std::vector<std::complex<Real>> shares;  ///< of the fields
    std::vector<Real> functionals;           ///< real parts, then imaginary ones
  };

  /// `crossing_times`: [owned_cells] of D M, which is a number a cell: its volume over the wave speeds.
  ReducedModel(std::vector<Real> crossing_times, Sum sum);

  /// Returns its number. Collective.
  std::size_t add_source(Source source);
  /// Widens the space by a real field, its image D A field, both [owned_cells], and its functionals, of all
  /// ranks; or does not, when it has it already. Collective.
  void add_field(std::vector<Primitive<Real>> field, std::vector<Primitive<Real>> image,
                 std::vector<Real> functionals);
  std::size_t size() const { return fields_.size(); }

  /// Of the first field alone, of the first two, and so on to all. The imaginary part of what is left counts
  /// `imaginary_weight` times in the norm. Needs no communication.
  std::vector<Projection> project(std::size_t source, Real omega, Real imaginary_weight) const;
  /// [2 owned_cells] the combination.
  std::vector<Primitive<Real>> field(const Projection& projection) const;

 private:
  /// Of orthonormal images q and of n = D M field, sums over all cells with those of the fields before and up
  /// to it.
  struct Field {
    std::vector<float> field, image;
    std::vector<Real> functionals;
    std::vector<Real> image_mass, mass_image, mass_mass;  ///< q_j . n, n_j . q, n_j . n for every j
  };
  struct KnownSource {
    Source source;
    Real square_real, square_imaginary;
    std::vector<Real> image_real, image_imaginary, mass_real,
        mass_imaginary;  ///< q . b and n . b of all fields
  };
  void add_products(KnownSource& source, std::size_t begin) const;

  std::vector<Real> times_;  // [5 owned_cells]
  Sum sum_;
  std::vector<Field> fields_;
  std::vector<KnownSource> sources_;
};

}  // namespace alphadot
