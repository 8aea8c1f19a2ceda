// GMRES for one right-hand side, driven from outside so that several can share the applications of one
// operator.
#pragma once

#include <Eigen/Dense>

#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "euler/state.hpp"

namespace alphadot {

/// A growing orthonormal basis with the least-squares problem of GMRES (Saad & Schultz 1986). Vectors are
/// [owned_cells] states; norms are over all ranks. Use:
///   start(r0); while not content: w = B direction(); extend(w);   then x += sum of weights()[j] * basis(j).
class KrylovSpace {
 public:
  KrylovSpace(std::size_t cells, int capacity, const Communicator& comm);

  /// Begins anew from a residual; returns its norm. Collective.
  Real start(std::span<const Primitive<Real>> residual);
  /// The vector to which the operator is to be applied next.
  std::span<const Primitive<Real>> direction() const { return basis_[static_cast<std::size_t>(size_)]; }
  /// Takes the operator times direction(); returns the norm of the residual that is left. Collective
  /// (classical Gram-Schmidt, done twice where most of the vector cancels).
  Real extend(std::span<const Primitive<Real>> image);
  bool is_full() const { return size_ == capacity_; }
  /// Number of directions used so far.
  int size() const { return size_; }
  /// Weights of the basis vectors in the present least-squares solution.
  Eigen::VectorXd weights() const;
  std::span<const Primitive<Real>> basis(int j) const { return basis_[static_cast<std::size_t>(j)]; }

  std::size_t bytes() const;

 private:
  std::vector<Real> project_out(std::vector<Primitive<Real>>& vector) const;

  const Communicator& comm_;
  int capacity_, size_ = 0;
  Real first_norm_ = 0;
  std::vector<std::vector<Primitive<Real>>> basis_;  // [capacity + 1]
  Eigen::MatrixXd hessenberg_;                       // (capacity + 1) x capacity
};

}  // namespace alphadot
