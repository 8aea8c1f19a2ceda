// Pressure forces on the walls.
#pragma once

#include <span>
#include <vector>

#include "space/residual.hpp"

namespace alphadot {

/// Force and moment of one patch, in units of rho_inf a_inf^2 times length^2 (^3), along mesh axes.
struct Load {
  Vec3 force, moment;

  Load& operator+=(const Load& b) {
    force += b.force;
    moment += b.moment;
    return *this;
  }
  friend Load operator+(Load a, const Load& b) { return a += b; }
  friend Load operator-(const Load& a, const Load& b) { return {a.force - b.force, a.moment - b.moment}; }
  friend Load operator*(Real s, const Load& a) { return {s * a.force, s * a.moment}; }
};

/// Loads as six numbers each - force, then moment - for sums over ranks and for files.
std::vector<Real> numbers_of(std::span<const Load> loads);
/// The way back.
std::vector<Load> loads_of(std::span<const Real> numbers);
/// Their sum.
Load total_of(std::span<const Load> loads);

/// [boundary_faces] of the latest evaluation: pressure above that of the free stream.
std::vector<Real> excess_pressures(const Discretization& discretization, const Residual& residual);
/// [boundary_faces] load of each face of a wall, of pressures above that of the free stream, moments about
/// `center`; zero elsewhere.
std::vector<Load> face_loads(const Discretization& discretization, std::span<const Real> excess_pressures,
                             const Vec3& center);
/// [patches] sums of those of faces.
std::vector<Load> patch_loads(const Discretization& discretization, std::span<const Load> of_faces);

/// Load of every patch that is a wall (zero for others): integral of (p - p_inf) n, moments about `center`,
/// with the pressures of the latest evaluation.
/// Summed over this rank only; the sum over ranks is the caller's, together with its other numbers.
std::vector<Load> wall_loads(const Discretization& discretization, const Residual& residual,
                             const Vec3& center);
/// The same of pressures above that of the free stream, [boundary_faces].
std::vector<Load> wall_loads(const Discretization& discretization, std::span<const Real> excess_pressures,
                             const Vec3& center);

}  // namespace alphadot
