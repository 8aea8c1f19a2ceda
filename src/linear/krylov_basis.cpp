#include "linear/krylov_basis.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace alphadot {

namespace {

/// Share of an image's norm below which it is made orthogonal twice, and below which nothing of it is left in
/// single precision.
constexpr Real largest_cancellation = 0.05, nothing_left = 1e-5;
/// Numbers that are worked on for all directions in turn, so that they stay in the cache.
constexpr std::size_t chunk = 4096;

/// The numbers of all cells in a row: sums over them need not know of cells.
template <class V>
auto numbers_in(std::span<V> vector) {
  using Scalar = std::conditional_t<std::is_const_v<V>, const Real, Real>;
  static_assert(sizeof(V) == 5 * sizeof(Real));
  return std::span(reinterpret_cast<Scalar*>(vector.data()), 5 * vector.size());
}

/// Sum of products, in as many partial sums as keep a processor's vector registers busy.
template <class T>
Real product(std::span<const T> a, std::span<const Real> b) {
  constexpr std::size_t lanes = 32;
  Real partial[lanes]{};
  const std::size_t whole = b.size() - b.size() % lanes;
  for (std::size_t i = 0; i < whole; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) partial[k] += static_cast<Real>(a[i + k]) * b[i + k];
  Real sum = 0;
  for (std::size_t i = whole; i < b.size(); ++i) sum += static_cast<Real>(a[i]) * b[i];
  for (const Real part : partial) sum += part;
  return sum;
}

void add_scaled(std::span<Real> to, Real factor, std::span<const float> vector) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * static_cast<Real>(vector[i]);
}

std::vector<float> scaled(Real factor, std::span<const Real> vector) {
  std::vector<float> out;
  out.reserve(vector.size());
  for (const Real number : vector) out.push_back(static_cast<float>(factor * number));
  return out;
}

/// What is left of a square when a vector loses its parts along orthonormal ones (Pythagoras).
Real square_left(Real whole, std::span<const Real> parts) {
  return std::max(whole - product(parts, parts), Real{0});
}

template <class Work>
void for_chunks(std::size_t numbers, Work&& work) {
  for (std::size_t begin = 0; begin < numbers; begin += chunk) work(begin, std::min(chunk, numbers - begin));
}

}  // namespace

Real square(std::span<const Primitive<Real>> vector) {
  return product(numbers_in(vector), numbers_in(vector));
}

KrylovBasis::KrylovBasis(std::size_t cells, int capacity, Sum sum)
    : cells_(cells), capacity_(capacity), sum_(std::move(sum)) {}

void KrylovBasis::add(std::span<const Candidate> candidates) {
  const std::size_t known = directions_.size(), stride = known + candidates.size();
  const auto images_of = [&](std::size_t j) { return std::span<const float>(directions_[j].image); };
  // Row k: products of image k with those of the space, then with those of the candidates up to itself.
  std::vector<Real> products(candidates.size() * stride);
  for_chunks(5 * cells_, [&](std::size_t begin, std::size_t count) {
    const auto part = [&](std::size_t k) { return numbers_in(candidates[k].image).subspan(begin, count); };
    for (std::size_t j = 0; j < known; ++j)
      for (std::size_t k = 0; k < candidates.size(); ++k)
        products[k * stride + j] += product<float>(images_of(j).subspan(begin, count), part(k));
    for (std::size_t k = 0; k < candidates.size(); ++k)
      for (std::size_t i = 0; i <= k; ++i)
        products[k * stride + known + i] += product<Real>(part(i), part(k));
  });
  sum_(products);
  for_chunks(5 * cells_, [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = 0; j < known; ++j)
      for (std::size_t k = 0; k < candidates.size(); ++k)
        add_scaled(numbers_in(candidates[k].image).subspan(begin, count), -products[k * stride + j],
                   images_of(j).subspan(begin, count));
  });

  std::vector<std::size_t> kept;  // of the candidates
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const auto row = std::span<const Real>(products).subspan(k * stride, stride);
    const Real whole = row[known + k];
    const auto image = numbers_in(candidates[k].image);
    std::vector<Real> column(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(known));
    for (const std::size_t i : kept) {  // as in Cholesky's decomposition
      const Direction& other = directions_[column.size()];
      column.push_back((row[known + i] - product<Real>(other.column, column)) / other.column.back());
      add_scaled(image, -column.back(), other.image);
    }
    Real left = square_left(whole, column);
    if (!(left > largest_cancellation * largest_cancellation * whole)) {
      std::vector<Real> again;
      for (const Direction& other : directions_) again.push_back(product<float>(other.image, image));
      again.push_back(product<Real>(image, image));
      sum_(again);
      for (std::size_t j = 0; j < directions_.size(); ++j) {
        column[j] += again[j];
        add_scaled(image, -again[j], images_of(j));
      }
      left = square_left(again.back(), std::span(again).first(directions_.size()));
    }
    if (!(left > nothing_left * nothing_left * whole)) continue;
    column.push_back(std::sqrt(left));
    keep(candidates[k], std::move(column));
    kept.push_back(k);
  }
}

void KrylovBasis::keep(const Candidate& candidate, std::vector<Real> column) {
  auto functionals = candidate.functionals;
  for (std::size_t i = 0; i < functionals.size(); ++i) {
    for (std::size_t j = 0; j < directions_.size(); ++j)
      functionals[i] -= column[j] * directions_[j].functionals[i];
    functionals[i] /= column.back();
  }
  directions_.push_back({scaled(1, numbers_in(candidate.direction)),
                         scaled(1 / column.back(), numbers_in(candidate.image)), std::move(column),
                         std::move(functionals)});
}

void KrylovBasis::reduce(std::span<System> systems) const {
  std::vector<Real> products;
  for (const System& system : systems) {
    const auto defect = numbers_in(std::span<const Primitive<Real>>(system.defect));
    for (std::size_t j = system.coefficients.size(); j < directions_.size(); ++j)
      products.push_back(-product<float>(directions_[j].image, defect));
    products.push_back(product<Real>(defect, defect));
  }
  sum_(products);
  auto next = products.begin();
  for (System& system : systems) {
    const std::size_t met = system.coefficients.size();
    for (std::size_t j = met; j < directions_.size(); ++j) {
      const Real coefficient = *next++;
      system.coefficients.push_back(coefficient);
      add_scaled(numbers_in(system.defect), coefficient, directions_[j].image);
      for (std::size_t i = 0; i < system.functionals.size(); ++i)
        system.functionals[i] += coefficient * directions_[j].functionals[i];
    }
    system.norm = std::sqrt(square_left(*next++, std::span(system.coefficients).subspan(met)));
  }
}

void KrylovBasis::move(std::span<Primitive<Real>> solution, std::span<const Real> coefficients) const {
  std::vector<Real> factors(coefficients.begin(), coefficients.end());  // R factors = coefficients
  for (std::size_t j = factors.size(); j-- > 0;) {
    const auto& column = directions_[j].column;
    factors[j] /= column.back();
    for (std::size_t i = 0; i < j; ++i) factors[i] -= column[i] * factors[j];
  }
  const auto numbers = numbers_in(solution);
  for_chunks(numbers.size(), [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = 0; j < factors.size(); ++j)
      add_scaled(numbers.subspan(begin, count), factors[j],
                 std::span(directions_[j].direction).subspan(begin, count));
  });
}

}  // namespace alphadot
