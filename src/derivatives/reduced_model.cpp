#include "derivatives/reduced_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace alphadot {

namespace {

/// Share of an image's norm below which nothing new is left of it in single precision.
constexpr Real nothing_new = 1e-5;

std::span<const Real> numbers_in(std::span<const Primitive<Real>> field) {
  return {reinterpret_cast<const Real*>(field.data()), 5 * field.size()};
}
std::span<Real> numbers_in(std::span<Primitive<Real>> field) {
  return {reinterpret_cast<Real*>(field.data()), 5 * field.size()};
}

/// Sum of products, in as many partial sums as keep a processor's vector registers busy.
template <class Term>
Real sum_of(std::size_t numbers, const Term& term) {
  constexpr std::size_t lanes = 32;
  Real partial[lanes]{};
  const std::size_t whole = numbers - numbers % lanes;
  for (std::size_t i = 0; i < whole; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) partial[k] += term(i + k);
  Real sum = 0;
  for (std::size_t i = whole; i < numbers; ++i) sum += term(i);
  for (const Real part : partial) sum += part;
  return sum;
}

template <class A, class B>
Real product(std::span<const A> a, std::span<const B> b) {
  return sum_of(a.size(), [&](std::size_t i) { return static_cast<Real>(a[i]) * static_cast<Real>(b[i]); });
}
template <class A, class B>
Real product(std::span<const Real> weights, std::span<const A> a, std::span<const B> b) {
  return sum_of(a.size(), [&](std::size_t i) {
    return weights[i] * static_cast<Real>(a[i]) * static_cast<Real>(b[i]);
  });
}

std::vector<float> rounded(std::span<const Real> numbers) {
  return {numbers.begin(), numbers.end()};
}

}  // namespace

ReducedModel::ReducedModel(std::vector<Real> crossing_times, Sum sum) : sum_(std::move(sum)) {
  times_.reserve(5 * crossing_times.size());
  for (const Real time : crossing_times) times_.insert(times_.end(), 5, time);
}

void ReducedModel::add_products(KnownSource& known, std::size_t begin) const {
  const auto b = numbers_in(std::span<const Primitive<Real>>(known.source.scaled));
  const auto real = b.first(times_.size()), imaginary = b.last(times_.size());
  std::vector<Real> sums;
  for (std::size_t j = begin; j < fields_.size(); ++j) {
    const std::span<const float> field(fields_[j].field), image(fields_[j].image);
    for (const auto part : {real, imaginary}) {
      sums.push_back(product(image, part));
      sums.push_back(product<float, Real>(times_, field, part));
    }
  }
  sum_(sums);
  auto next = sums.begin();
  for (std::size_t j = begin; j < fields_.size(); ++j) {
    for (auto* products :
         {&known.image_real, &known.mass_real, &known.image_imaginary, &known.mass_imaginary})
      products->push_back(*next++);
  }
}

std::size_t ReducedModel::add_source(Source source) {
  KnownSource known{std::move(source), 0, 0, {}, {}, {}, {}};
  const auto b = numbers_in(std::span<const Primitive<Real>>(known.source.scaled));
  const auto real = b.first(times_.size()), imaginary = b.last(times_.size());
  std::vector<Real> squares{product(real, real), product(imaginary, imaginary)};
  sum_(squares);
  known.square_real = squares[0];
  known.square_imaginary = squares[1];
  add_products(known, 0);
  sources_.push_back(std::move(known));
  return sources_.size() - 1;
}

void ReducedModel::add_field(std::vector<Primitive<Real>> field, std::vector<Primitive<Real>> image,
                             std::vector<Real> functionals) {
  const auto v = numbers_in(std::span(field)), q = numbers_in(std::span(image));
  const auto square = [&] {
    std::vector<Real> out{product<Real, Real>(q, q)};
    sum_(out);
    return out[0];
  };
  const Real whole = square();
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<Real> shares;
    for (const Field& other : fields_) shares.push_back(product<float, Real>(other.image, q));
    sum_(shares);
    for (std::size_t j = 0; j < fields_.size(); ++j) {
      for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] -= shares[j] * static_cast<Real>(fields_[j].field[i]);
        q[i] -= shares[j] * static_cast<Real>(fields_[j].image[i]);
      }
      for (std::size_t i = 0; i < functionals.size(); ++i)
        functionals[i] -= shares[j] * fields_[j].functionals[i];
    }
  }
  const Real left = square();
  if (!(left > nothing_new * nothing_new * whole)) return;
  const Real factor = 1 / std::sqrt(left);
  for (auto numbers : {v, q})
    for (Real& number : numbers) number *= factor;
  for (Real& functional : functionals) functional *= factor;
  fields_.push_back({rounded(v), rounded(q), std::move(functionals), {}, {}, {}});

  Field& latest = fields_.back();
  const std::span<const float> n(latest.field), own_image(latest.image);
  std::vector<Real> squared_times(times_.size());
  std::ranges::transform(times_, squared_times.begin(), [](Real time) { return time * time; });
  std::vector<Real> sums;
  for (const Field& other : fields_) {
    const std::span<const float> other_field(other.field), other_image(other.image);
    sums.push_back(product<float, float>(times_, other_image, n));
    sums.push_back(product<float, float>(times_, other_field, own_image));
    sums.push_back(product<float, float>(squared_times, other_field, n));
  }
  sum_(sums);
  for (std::size_t j = 0; j < fields_.size(); ++j) {
    latest.image_mass.push_back(sums[3 * j]);
    latest.mass_image.push_back(sums[3 * j + 1]);
    latest.mass_mass.push_back(sums[3 * j + 2]);
  }
  for (auto& source : sources_) add_products(source, fields_.size() - 1);
}

std::vector<ReducedModel::Projection> ReducedModel::project(std::size_t which, Real omega,
                                                            Real imaginary_weight) const {
  // With the shares a + i c: the real part of what is left is b + q a - omega n c, the imaginary one b' + q c
  // + omega n a. Unknowns are (a, c) of one field after the other.
  const KnownSource& source = sources_[which];
  const auto fields = static_cast<Eigen::Index>(fields_.size());
  const Real weight = imaginary_weight * imaginary_weight;
  Eigen::MatrixXd normal(2 * fields, 2 * fields);
  Eigen::VectorXd right(2 * fields);
  for (std::size_t j = 0; j < fields_.size(); ++j) {
    const auto column = 2 * static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      const Real same = i == j ? 1 : 0, mass = omega * omega * fields_[j].mass_mass[i];
      const Real qn = omega * fields_[j].image_mass[i], nq = omega * fields_[j].mass_image[i];
      Eigen::Matrix2d block;
      block << same + weight * mass, -qn + weight * nq,  //
          -nq + weight * qn, mass + weight * same;
      normal.block<2, 2>(row, column) = block;
      normal.block<2, 2>(column, row) = block.transpose();
    }
    right[column] = -(source.image_real[j] + weight * omega * source.mass_imaginary[j]);
    right[column + 1] = -(-omega * source.mass_real[j] + weight * source.image_imaginary[j]);
  }
  // Leading parts of Cholesky's factor are those of the first fields alone.
  const Eigen::LLT<Eigen::MatrixXd> factors(normal);
  const Eigen::MatrixXd lower = factors.matrixL();
  const Eigen::VectorXd half = lower.triangularView<Eigen::Lower>().solve(right);
  std::vector<Projection> out;
  Real left = source.square_real + weight * source.square_imaginary;
  for (Eigen::Index m = 1; m <= fields; ++m) {
    left -= half.segment(2 * m - 2, 2).squaredNorm();
    const Eigen::VectorXd unknowns =
        lower.topLeftCorner(2 * m, 2 * m).transpose().triangularView<Eigen::Upper>().solve(half.head(2 * m));
    Projection projection{std::sqrt(std::max(left, Real{0})), {}, source.source.functionals};
    const std::size_t functionals = projection.functionals.size() / 2;
    for (Eigen::Index j = 0; j < m; ++j) {
      const Real real = unknowns[2 * j], imaginary = unknowns[2 * j + 1];
      projection.shares.emplace_back(real, imaginary);
      const auto& of_field = fields_[static_cast<std::size_t>(j)].functionals;
      for (std::size_t i = 0; i < functionals; ++i) {
        projection.functionals[i] += real * of_field[i];
        projection.functionals[functionals + i] += imaginary * of_field[i];
      }
    }
    out.push_back(std::move(projection));
  }
  return out;
}

std::vector<Primitive<Real>> ReducedModel::field(const Projection& projection) const {
  std::vector<Primitive<Real>> out(2 * times_.size() / 5);
  const auto numbers = numbers_in(std::span(out));
  const auto real = numbers.first(times_.size()), imaginary = numbers.last(times_.size());
  for (std::size_t j = 0; j < projection.shares.size(); ++j) {
    const std::span<const float> field(fields_[j].field);
    const Real a = projection.shares[j].real(), c = projection.shares[j].imag();
    for (std::size_t i = 0; i < field.size(); ++i) {
      real[i] += a * static_cast<Real>(field[i]);
      imaginary[i] += c * static_cast<Real>(field[i]);
    }
  }
  return out;
}

}  // namespace alphadot
