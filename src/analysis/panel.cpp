#include "analysis/panel.hpp"

namespace alphadot {

namespace {

/// None of what is as good as zero.
Vec3 unit(const Vec3& v) {
  constexpr Real nothing = 1e-9;
  return norm(v) > nothing ? 1 / norm(v) * v : Vec3{};
}

}  // namespace

PanelFrame::PanelFrame(const Vec3& point_, const Vec3& axis_)
    : point(point_),
      axis(axis_),
      normal(unit(cross(Vec3{1, 0, 0}, axis))),
      outboard(unit(Vec3{0, axis.y, axis.z})) {}

}  // namespace alphadot
