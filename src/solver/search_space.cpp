#include "solver/search_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alphadot {

namespace {

/// Share of an image's norm below which it is made orthogonal twice, and below which nothing of it is left in
/// single precision.
constexpr Real largest_cancellation = 0.05, nothing_left = 1e-5;
/// Cells that are worked on for all directions in turn, so that they stay in the cache.
constexpr std::size_t chunk = 1024;

void subtract(std::span<Primitive<Real>> from, Real factor, std::span<const Five<float>> vector) {
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int k = 0; k < 5; ++k) from[i][k] -= factor * static_cast<Real>(vector[i][k]);
}

/// Of a vector that has lost its parts along orthonormal ones (Pythagoras): its products with these, and at
/// the end its square before.
Real square_left(std::span<const Real> products) {
  Real left = products.back();
  for (const Real product : products.first(products.size() - 1)) left -= product * product;
  return std::max(left, Real{0});
}

template <class Work>
void for_chunks(std::size_t cells, Work&& work) {
  for (std::size_t begin = 0; begin < cells; begin += chunk) work(begin, std::min(chunk, cells - begin));
}

}  // namespace

Real square(std::span<const Primitive<Real>> vector) {
  Real sum = 0;
  for (const auto& value : vector)
    for (int k = 0; k < 5; ++k) sum += value[k] * value[k];
  return sum;
}

SearchSpace::SearchSpace(std::size_t cells, int capacity, const Communicator& comm)
    : comm_(comm), cells_(cells), capacity_(capacity) {}

std::vector<Real> SearchSpace::products(std::size_t first, std::span<const Primitive<Real>> vector) const {
  std::vector<Real> out(directions_.size() - first);
  for_chunks(cells_, [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = first; j < directions_.size(); ++j) {
      Real sum = 0;
      const Five<float>* image = directions_[j].image.data();
      for (std::size_t i = begin; i < begin + count; ++i)
        for (int k = 0; k < 5; ++k) sum += static_cast<Real>(image[i][k]) * vector[i][k];
      out[j - first] += sum;
    }
  });
  out.push_back(square(vector));
  comm_.sum(out);
  return out;
}

void SearchSpace::add(std::span<Primitive<Real>> direction, std::span<Primitive<Real>> image,
                      std::vector<Real> functionals) {
  Real whole = 0, left = 0;
  for (int pass = 0; pass < 2; ++pass) {
    const auto factors = products(0, image);
    const Real before = std::sqrt(factors.back());
    if (pass == 0) whole = before;
    for_chunks(cells_, [&](std::size_t begin, std::size_t count) {
      for (std::size_t j = 0; j < directions_.size(); ++j) {
        subtract(image.subspan(begin, count), factors[j],
                 std::span(directions_[j].image).subspan(begin, count));
        subtract(direction.subspan(begin, count), factors[j],
                 std::span(directions_[j].direction).subspan(begin, count));
      }
    });
    for (std::size_t j = 0; j < directions_.size(); ++j)
      for (std::size_t i = 0; i < functionals.size(); ++i)
        functionals[i] -= factors[j] * directions_[j].functionals[i];
    left = std::sqrt(square_left(factors));
    if (left > largest_cancellation * before) break;
  }
  if (!(left > nothing_left * whole)) return;

  Direction& next = directions_.emplace_back();
  next.direction.resize(cells_);
  next.image.resize(cells_);
  for (std::size_t i = 0; i < cells_; ++i)
    for (int k = 0; k < 5; ++k) {
      next.direction[i][k] = static_cast<float>(direction[i][k] / left);
      next.image[i][k] = static_cast<float>(image[i][k] / left);
    }
  for (Real& value : functionals) value /= left;
  next.functionals = std::move(functionals);
}

Real SearchSpace::reduce(int first, std::span<Primitive<Real>> defect, std::span<Primitive<Real>> solution,
                         std::span<Real> functionals) const {
  const auto begin_with = static_cast<std::size_t>(first);
  const auto factors = products(begin_with, defect);
  for_chunks(cells_, [&](std::size_t begin, std::size_t count) {
    for (std::size_t j = begin_with; j < directions_.size(); ++j) {
      const Real factor = factors[j - begin_with];
      subtract(defect.subspan(begin, count), factor, std::span(directions_[j].image).subspan(begin, count));
      subtract(solution.subspan(begin, count), -factor,
               std::span(directions_[j].direction).subspan(begin, count));
    }
  });
  for (std::size_t j = begin_with; j < directions_.size(); ++j)
    for (std::size_t i = 0; i < functionals.size(); ++i)
      functionals[i] += factors[j - begin_with] * directions_[j].functionals[i];
  return square_left(factors);
}

}  // namespace alphadot
