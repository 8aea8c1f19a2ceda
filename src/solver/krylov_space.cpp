#include "solver/krylov_space.hpp"

#include <cmath>

namespace alphadot {

namespace {

constexpr Real largest_cancellation = 0.05;  // of a vector's norm, before it is made orthogonal twice

Real local_dot(std::span<const Primitive<Real>> a, std::span<const Primitive<Real>> b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 5; ++k) sum += a[i][k] * b[i][k];
  return sum;
}

void scale(std::vector<Primitive<Real>>& vector, Real factor) {
  for (auto& value : vector) value = factor * value;
}

}  // namespace

KrylovSpace::KrylovSpace(std::size_t cells, int capacity, const Communicator& comm)
    : comm_(comm),
      capacity_(capacity),
      basis_(static_cast<std::size_t>(capacity) + 1, std::vector<Primitive<Real>>(cells)),
      hessenberg_(Eigen::MatrixXd::Zero(capacity + 1, capacity)) {}

Real KrylovSpace::start(std::span<const Primitive<Real>> residual) {
  size_ = 0;
  hessenberg_.setZero();
  basis_[0].assign(residual.begin(), residual.end());
  first_norm_ = std::sqrt(comm_.sum(local_dot(residual, residual)));
  if (first_norm_ > 0) scale(basis_[0], 1 / first_norm_);
  return first_norm_;
}

std::vector<Real> KrylovSpace::project_out(std::vector<Primitive<Real>>& vector) const {
  std::vector<Real> products;
  for (int j = 0; j <= size_; ++j) products.push_back(local_dot(basis(j), vector));
  comm_.sum(products);
  for (int j = 0; j <= size_; ++j)
    for (std::size_t i = 0; i < vector.size(); ++i)
      vector[i] -= products[static_cast<std::size_t>(j)] * basis(j)[i];
  return products;
}

Real KrylovSpace::extend(std::span<const Primitive<Real>> image) {
  auto& next = basis_[static_cast<std::size_t>(size_) + 1];
  next.assign(image.begin(), image.end());
  // Once more only where most of the vector has cancelled and round-off would spoil what is left.
  Real norm_before = std::sqrt(comm_.sum(local_dot(next, next))), norm_left = 0;
  for (int pass = 0; pass < 2; ++pass) {
    const auto products = project_out(next);
    for (int j = 0; j <= size_; ++j) hessenberg_(j, size_) += products[static_cast<std::size_t>(j)];
    norm_left = std::sqrt(comm_.sum(local_dot(next, next)));
    if (norm_left > largest_cancellation * norm_before) break;
    norm_before = norm_left;
  }
  hessenberg_(size_ + 1, size_) = norm_left;
  if (norm_left > 0) scale(next, 1 / norm_left);
  ++size_;

  const auto h = hessenberg_.topLeftCorner(size_ + 1, size_);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size_ + 1);
  right(0) = first_norm_;
  return (right - h * weights()).norm();
}

Eigen::VectorXd KrylovSpace::weights() const {
  if (size_ == 0) return {};
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size_ + 1);
  right(0) = first_norm_;
  return hessenberg_.topLeftCorner(size_ + 1, size_).colPivHouseholderQr().solve(right);
}

std::size_t KrylovSpace::bytes() const {
  return basis_.size() * basis_[0].size() * sizeof(Primitive<Real>);
}

}  // namespace alphadot
