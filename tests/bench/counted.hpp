// A number that counts what is done to it: the solver's templates, compiled for it, tell their own flops.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/types.hpp"

namespace alphadot {

/// Operations so far on all Counted numbers of this process.
struct Operations {
  std::int64_t sums = 0;      ///< additions and subtractions, of two numbers or with a constant
  std::int64_t products = 0;  ///< of two numbers
  std::int64_t scalings = 0;  ///< products with, and quotients by, a constant
  std::int64_t quotients = 0;
  std::int64_t roots = 0;

  std::int64_t flops() const { return sums + products + scalings + quotients + roots; }
};

class Counted {
 public:
  Counted() = default;
  Counted(Real value) : value_(value) {}

  static inline Operations operations;

  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }

  friend Counted operator+(const Counted& a, const Counted& b) {
    return a.by(operations.sums, a.value_ + b.value_);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    return a.by(operations.sums, a.value_ - b.value_);
  }
  friend Counted operator-(const Counted& a) { return -a.value_; }
  friend Counted operator*(const Counted& a, const Counted& b) {
    return a.by(operations.products, a.value_ * b.value_);
  }
  friend Counted operator*(Real a, const Counted& b) { return b.by(operations.scalings, a * b.value_); }
  friend Counted operator*(const Counted& a, Real b) { return b * a; }
  friend Counted operator/(const Counted& a, const Counted& b) {
    return a.by(operations.quotients, a.value_ / b.value_);
  }
  friend Counted operator/(const Counted& a, Real b) { return a.by(operations.scalings, a.value_ / b); }

  friend bool operator<(const Counted& a, const Counted& b) { return a.value_ < b.value_; }
  friend bool operator>(const Counted& a, const Counted& b) { return a.value_ > b.value_; }
  friend bool operator<=(const Counted& a, const Counted& b) { return a.value_ <= b.value_; }
  friend bool operator>=(const Counted& a, const Counted& b) { return a.value_ >= b.value_; }

  friend Counted sqrt(const Counted& a) { return a.by(operations.roots, std::sqrt(a.value_)); }
  friend Counted pow(const Counted& a, Real b) { return a.by(operations.roots, std::pow(a.value_, b)); }
  friend Counted abs(const Counted& a) { return std::abs(a.value_); }
  friend Real value_of(const Counted& a) { return a.value_; }

 private:
  Counted by(std::int64_t& count, Real value) const {
    ++count;
    return value;
  }

  Real value_ = 0;
};

}  // namespace alphadot
