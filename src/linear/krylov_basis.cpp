#include "linear/krylov_basis.hpp"

#include <algorithm>
#include <array>
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
  using Entry = std::conditional_t<std::is_const_v<V>, const Real, Real>;
  static_assert(sizeof(V) == 5 * sizeof(Real));
  return std::span(reinterpret_cast<Entry*>(vector.data()), 5 * vector.size());
}

/// Some of a vector's numbers, and of a complex one the imaginary parts that go with them.
template <class T, std::size_t parts>
using Stretch = std::array<std::span<T>, parts>;

template <std::size_t parts, class T>
Stretch<T, parts> stretch(std::span<T> numbers, std::size_t begin, std::size_t count) {
  Stretch<T, parts> out;
  for (std::size_t part = 0; part < parts; ++part)
    out[part] = numbers.subspan(part * (numbers.size() / parts) + begin, count);
  return out;
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

template <class T, class B>
Real product(const Stretch<T, 1>& a, const Stretch<B, 1>& b) {
  return product(std::span<const std::remove_const_t<T>>(a[0]), std::span<const Real>(b[0]));
}
/// Of the first one's complex conjugate.
template <class T, class B>
std::complex<Real> product(const Stretch<T, 2>& a, const Stretch<B, 2>& b) {
  using Numbers = std::span<const std::remove_const_t<T>>;
  const auto of = [&](std::size_t i, std::size_t j) {
    return product(Numbers(a[i]), std::span<const Real>(b[j]));
  };
  return {of(0, 0) + of(1, 1), of(0, 1) - of(1, 0)};
}

void add_scaled(std::span<Real> to, Real factor, std::span<const float> vector) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * static_cast<Real>(vector[i]);
}
void add_scaled(const Stretch<Real, 1>& to, Real factor, const Stretch<const float, 1>& vector) {
  add_scaled(to[0], factor, vector[0]);
}
void add_scaled(const Stretch<Real, 2>& to, std::complex<Real> factor,
                const Stretch<const float, 2>& vector) {
  const Real real = factor.real(), imaginary = factor.imag();
  for (std::size_t i = 0; i < to[0].size(); ++i) {
    const auto a = static_cast<Real>(vector[0][i]), b = static_cast<Real>(vector[1][i]);
    to[0][i] += real * a - imaginary * b;
    to[1][i] += real * b + imaginary * a;
  }
}

std::vector<float> scaled(Real factor, std::span<const Real> vector) {
  std::vector<float> out(vector.size());
  std::ranges::transform(vector, out.begin(), [&](Real n) { return static_cast<float>(factor * n); });
  return out;
}

/// What is left of a square when a vector loses its parts along orthonormal ones (Pythagoras).
template <class Scalar>
Real square_left(Real whole, std::span<const Scalar> shares) {
  for (const Scalar share : shares) whole -= std::norm(share);
  return std::max(whole, Real{0});
}

/// conj(a) . b of the first entries, as many as `b` has.
template <class Scalar>
Scalar inner(std::span<const Scalar> a, std::span<const Scalar> b) {
  Scalar sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    if constexpr (std::is_same_v<Scalar, Real>)
      sum += a[i] * b[i];
    else
      sum += std::conj(a[i]) * b[i];
  return sum;
}

template <class Work>
void for_chunks(std::size_t numbers, Work&& work) {
  for (std::size_t begin = 0; begin < numbers; begin += chunk) work(begin, std::min(chunk, numbers - begin));
}

}  // namespace

Real square(std::span<const Primitive<Real>> vector) {
  return product(numbers_in(vector), numbers_in(vector));
}

template <class Scalar>
KrylovBasis<Scalar>::KrylovBasis(std::size_t cells, int capacity, Sum sum)
    : cells_(cells), capacity_(capacity), sum_(std::move(sum)) {}

template <class Scalar>
void KrylovBasis<Scalar>::sum(std::vector<Scalar>& numbers) const {
  if constexpr (parts == 1) {
    sum_(numbers);
  } else {
    std::vector<Real> real(2 * numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      real[2 * i] = numbers[i].real();
      real[2 * i + 1] = numbers[i].imag();
    }
    sum_(real);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = {real[2 * i], real[2 * i + 1]};
  }
}

template <class Scalar>
void KrylovBasis<Scalar>::add(std::span<const Candidate> candidates) {
  const std::size_t known = directions_.size(), stride = known + candidates.size(), numbers = 5 * cells_;
  const auto image_of = [&](std::size_t j, std::size_t begin, std::size_t count) {
    return stretch<parts>(std::span<const float>(directions_[j].image), begin, count);
  };
  // Row k: products of image k with those of the space, then with those of the candidates up to itself.
  std::vector<Scalar> products(candidates.size() * stride);
  for_chunks(numbers, [&](std::size_t begin, std::size_t count) {
    const auto part = [&](std::size_t k) {
      return stretch<parts>(numbers_in(candidates[k].image), begin, count);
    };
    for (std::size_t j = 0; j < known; ++j)
      for (std::size_t k = 0; k < candidates.size(); ++k)
        products[k * stride + j] += product(image_of(j, begin, count), part(k));
    for (std::size_t k = 0; k < candidates.size(); ++k)
      for (std::size_t i = 0; i <= k; ++i) products[k * stride + known + i] += product(part(i), part(k));
  });
  sum(products);
  for_chunks(numbers, [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = 0; j < known; ++j)
      for (std::size_t k = 0; k < candidates.size(); ++k)
        add_scaled(stretch<parts>(numbers_in(candidates[k].image), begin, count), -products[k * stride + j],
                   image_of(j, begin, count));
  });

  std::vector<std::size_t> kept;  // of the candidates
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const auto row = std::span<const Scalar>(products).subspan(k * stride, stride);
    const Real whole = std::real(row[known + k]);
    const auto image = stretch<parts>(numbers_in(candidates[k].image), 0, numbers);
    std::vector<Scalar> column(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(known));
    for (const std::size_t i : kept) {  // as in Cholesky's decomposition
      const Direction& other = directions_[column.size()];
      column.push_back((row[known + i] - inner<Scalar>(other.column, column)) /
                       std::real(other.column.back()));
      add_scaled(image, -column.back(), image_of(column.size() - 1, 0, numbers));
    }
    Real left = square_left<Scalar>(whole, column);
    if (!(left > largest_cancellation * largest_cancellation * whole)) {
      std::vector<Scalar> again;
      for (std::size_t j = 0; j < directions_.size(); ++j)
        again.push_back(product(image_of(j, 0, numbers), image));
      again.push_back(product(image, image));
      sum(again);
      for (std::size_t j = 0; j < directions_.size(); ++j) {
        column[j] += again[j];
        add_scaled(image, -again[j], image_of(j, 0, numbers));
      }
      left = square_left<Scalar>(std::real(again.back()), std::span(again).first(directions_.size()));
    }
    if (!(left > nothing_left * nothing_left * whole)) continue;
    column.push_back(std::sqrt(left));
    keep(candidates[k], std::move(column));
    kept.push_back(k);
  }
}

template <class Scalar>
void KrylovBasis<Scalar>::keep(const Candidate& candidate, std::vector<Scalar> column) {
  auto functionals = candidate.functionals;
  const Real diagonal = std::real(column.back());
  for (std::size_t i = 0; i < functionals.size(); ++i) {
    for (std::size_t j = 0; j < directions_.size(); ++j)
      functionals[i] -= column[j] * directions_[j].functionals[i];
    functionals[i] /= diagonal;
  }
  directions_.push_back({scaled(1, numbers_in(candidate.direction)),
                         scaled(1 / diagonal, numbers_in(candidate.image)), std::move(column),
                         std::move(functionals)});
}

template <class Scalar>
void KrylovBasis<Scalar>::reduce(std::span<System> systems) const {
  const std::size_t numbers = 5 * cells_;
  const auto image_of = [&](std::size_t j) {
    return stretch<parts>(std::span<const float>(directions_[j].image), 0, numbers);
  };
  std::vector<Scalar> products;
  for (const System& system : systems) {
    const auto defect = stretch<parts>(numbers_in(system.defect), 0, numbers);
    for (std::size_t j = system.coefficients.size(); j < directions_.size(); ++j)
      products.push_back(-product(image_of(j), defect));
    products.push_back(product(defect, defect));
  }
  sum(products);
  auto next = products.begin();
  for (System& system : systems) {
    const std::size_t met = system.coefficients.size();
    for (std::size_t j = met; j < directions_.size(); ++j) {
      const Scalar coefficient = *next++;
      system.coefficients.push_back(coefficient);
      add_scaled(stretch<parts>(numbers_in(system.defect), 0, numbers), coefficient, image_of(j));
      for (std::size_t i = 0; i < system.functionals.size(); ++i)
        system.functionals[i] += coefficient * directions_[j].functionals[i];
    }
    system.norm =
        std::sqrt(square_left<Scalar>(std::real(*next++), std::span(system.coefficients).subspan(met)));
  }
}

template <class Scalar>
void KrylovBasis<Scalar>::move(std::span<Primitive<Real>> solution,
                               std::span<const Scalar> coefficients) const {
  std::vector<Scalar> factors(coefficients.begin(), coefficients.end());  // R factors = coefficients
  for (std::size_t j = factors.size(); j-- > 0;) {
    const auto& column = directions_[j].column;
    factors[j] /= std::real(column.back());
    for (std::size_t i = 0; i < j; ++i) factors[i] -= column[i] * factors[j];
  }
  for_chunks(5 * cells_, [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = 0; j < factors.size(); ++j)
      add_scaled(stretch<parts>(numbers_in(solution), begin, count), factors[j],
                 stretch<parts>(std::span<const float>(directions_[j].direction), begin, count));
  });
}

template class KrylovBasis<Real>;
template class KrylovBasis<std::complex<Real>>;

}  // namespace alphadot
