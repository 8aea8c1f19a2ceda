#include "io/element_cutting.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace alphadot {
namespace {

using Tetrahedron = std::array<GlobalIndex, 4>;

/// The faces of a shape with n corners, right-handed about the outward normal. A triangle repeats a corner.
template <std::size_t n>
constexpr auto faces_of() {
  using Face = std::array<int, 4>;
  if constexpr (n == 5)
    return std::array<Face, 5>{{{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}};
  else if constexpr (n == 6)
    return std::array<Face, 5>{{{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
  else
    return std::array<Face, 6>{
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
}

/// The corners at which three edges meet, each with its neighbours, right-handed.
template <std::size_t n>
constexpr auto corners_of() {
  using Corner = std::array<int, 4>;
  if constexpr (n == 4)
    return std::array<Corner, 4>{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}}};
  else if constexpr (n == 5)
    return std::array<Corner, 4>{{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
  else if constexpr (n == 6)
    return std::array<Corner, 6>{
        {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
  else
    return std::array<Corner, 8>{{{0, 1, 3, 4},
                                  {1, 2, 0, 5},
                                  {2, 3, 1, 6},
                                  {3, 0, 2, 7},
                                  {4, 7, 5, 0},
                                  {5, 4, 6, 1},
                                  {6, 5, 7, 2},
                                  {7, 6, 4, 3}}};
}

/// Product of three unit edges at a corner of the ideal shape: a square base under equilateral triangles, an
/// equilateral triangle times its edge, a cube.
template <std::size_t n>
Real ideal_product() {
  return n == 8 ? 1 : n == 6 ? std::sqrt(0.75) : std::sqrt(0.5);
}

Real volume_of(const Tetrahedron& cell, const std::vector<Vec3>& points) {
  const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(cell[i])]; };
  return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
}

/// Positive for right-handed elements.
template <std::size_t n>
Real scaled_jacobian(const std::array<GlobalIndex, n>& element, const std::vector<Vec3>& points) {
  const auto at = [&](int i) {
    return points[static_cast<std::size_t>(element[static_cast<std::size_t>(i)])];
  };
  Real least = std::numeric_limits<Real>::max();
  for (const auto& [corner, a, b, c] : corners_of<n>()) {
    const Vec3 u = at(a) - at(corner), v = at(b) - at(corner), w = at(c) - at(corner);
    const Real lengths = norm(u) * norm(v) * norm(w);
    least = std::min(least, lengths > 0 ? dot(cross(u, v), w) / lengths : 0);
  }
  return std::min<Real>(1, least / ideal_product<n>());
}

template <std::size_t n>
bool is_thin(const std::array<GlobalIndex, n>& element, const std::vector<Vec3>& points) {
  Real shortest = std::numeric_limits<Real>::max(), longest = 0;
  for (const auto& face : faces_of<n>())
    for (std::size_t i = 0; i < 4; ++i) {
      const auto a = element[static_cast<std::size_t>(face[i])],
                 b = element[static_cast<std::size_t>(face[(i + 1) % 4])];
      if (a == b) continue;
      const Real length = norm(points[static_cast<std::size_t>(b)] - points[static_cast<std::size_t>(a)]);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
  return longest > 50 * shortest;
}

/// The tetrahedra of one element.
class Cut {
 public:
  /// Joins the triangles of all faces that do not hold `apex` to it.
  template <std::size_t n>
  Cut(const std::array<GlobalIndex, n>& element, GlobalIndex apex, const std::vector<Vec3>& points) {
    for (const auto& face : faces_of<n>()) {
      std::array<GlobalIndex, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = element[static_cast<std::size_t>(face[i])];
      if (std::find(corners.begin(), corners.end(), apex) != corners.end()) continue;
      for_each_triangle(corners, [&](const std::array<GlobalIndex, 3>& triangle) {
        cells_[size_++] = {triangle[0], triangle[2], triangle[1], apex};
      });
    }
    for (const Tetrahedron& cell : cells()) volume_ += volume_of(cell, points);
    left_handed_ = volume_ < 0;
    if (left_handed_) {
      volume_ = -volume_;
      for (std::size_t i = 0; i < size_; ++i) std::swap(cells_[i][0], cells_[i][1]);
    }
    for (const Tetrahedron& cell : cells()) least_ = std::min(least_, volume_of(cell, points));
  }

  std::span<const Tetrahedron> cells() const { return {cells_.data(), size_}; }
  bool left_handed() const { return left_handed_; }
  Real volume() const { return volume_; }
  /// Whether every tetrahedron has its share of the volume, however small.
  bool sound() const { return least_ > 1e-6 * volume_; }
  /// Whether every tetrahedron has a volume.
  bool positive() const { return least_ > 0; }

 private:
  std::array<Tetrahedron, 12> cells_;
  std::size_t size_ = 0;
  Real volume_ = 0, least_ = std::numeric_limits<Real>::max();
  bool left_handed_ = false;
};

/// The same element with its inside out.
template <std::size_t n>
std::array<GlobalIndex, n> turned(std::array<GlobalIndex, n> e) {
  if constexpr (n == 5) {
    std::swap(e[1], e[3]);
  } else {
    for (std::size_t i = 0; i < n / 2; ++i) std::swap(e[i], e[i + n / 2]);
  }
  return e;
}

}  // namespace

const char* plural(Shape shape) {
  constexpr std::array names{"triangles", "quadrilaterals", "tetrahedra", "pyramids", "prisms", "hexahedra"};
  return names[static_cast<std::size_t>(shape)];
}

CuttingTally& CuttingTally::operator+=(const CuttingTally& other) {
  elements += other.elements;
  tetrahedra += other.tetrahedra;
  with_inner_point += other.with_inner_point;
  left_handed += other.left_handed;
  collapsed += other.collapsed;
  thin += other.thin;
  for (Quality CuttingTally::*quality : {&CuttingTally::before, &CuttingTally::after}) {
    (this->*quality).least = std::min((this->*quality).least, (other.*quality).least);
    (this->*quality).sum += (other.*quality).sum;
  }
  return *this;
}

template <std::size_t n>
CuttingTally cut_elements(std::span<const std::array<GlobalIndex, n>> elements, std::vector<Vec3>& points,
                          std::vector<std::array<GlobalIndex, 4>>& cells) {
  constexpr std::size_t usual = n == 8 ? 6 : n == 6 ? 3 : 2;
  const std::size_t needed = cells.size() + usual * elements.size();
  if (needed > cells.capacity()) cells.reserve(std::max(needed, cells.capacity() + cells.capacity() / 2));
  CuttingTally tally;
  tally.elements = static_cast<GlobalIndex>(elements.size());
  for (const auto& element : elements) {
    Cut cut(element, *std::min_element(element.begin(), element.end()), points);
    if (cut.cells().empty()) {
      ++tally.collapsed;
      continue;
    }
    if (!cut.sound()) {
      Vec3 center;
      for (const GlobalIndex point : element)
        center += (Real{1} / n) * points[static_cast<std::size_t>(point)];
      points.push_back(center);
      const Cut about_center(element, static_cast<GlobalIndex>(points.size() - 1), points);
      if (about_center.sound() || (about_center.positive() && !cut.positive())) {
        cut = about_center;
        ++tally.with_inner_point;
      } else {
        points.pop_back();
      }
    }
    tally.left_handed += cut.left_handed();
    tally.thin += is_thin(element, points);
    tally.before.add(scaled_jacobian(cut.left_handed() ? turned(element) : element, points));
    tally.tetrahedra += static_cast<GlobalIndex>(cut.cells().size());
    for (const Tetrahedron& cell : cut.cells()) {
      tally.after.add(scaled_jacobian(cell, points));
      cells.push_back(cell);
    }
  }
  return tally;
}

template CuttingTally cut_elements(std::span<const std::array<GlobalIndex, 5>>, std::vector<Vec3>&,
                                   std::vector<std::array<GlobalIndex, 4>>&);
template CuttingTally cut_elements(std::span<const std::array<GlobalIndex, 6>>, std::vector<Vec3>&,
                                   std::vector<std::array<GlobalIndex, 4>>&);
template CuttingTally cut_elements(std::span<const std::array<GlobalIndex, 8>>, std::vector<Vec3>&,
                                   std::vector<std::array<GlobalIndex, 4>>&);

}  // namespace alphadot
