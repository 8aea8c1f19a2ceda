// Loads of a panel that turns about a hinge, in its own frame.
#pragma once

#include <array>
#include <string_view>

#include "analysis/coefficients.hpp"
#include "core/flight.hpp"

namespace alphadot {

/// Of a hinge through `point`, for a panel where the hinge line meets the root, along `axis`, a unit vector
/// that points outboard. A deflection is positive by the right-hand rule about it.
struct PanelFrame {
  PanelFrame(const Vec3& point_, const Vec3& axis_);

  Vec3 point, axis;
  /// Across the axis and x, to where a positive deflection moves the leading edge; zero for a hinge along x.
  Vec3 normal;
  Vec3 outboard;  ///< across x and the normal
};

/// Over q_inf S and q_inf S l, with the reference area and length of the configuration.
template <class T>
struct PanelLoads {
  T normal{};   ///< force along the frame's normal
  T hinge{};    ///< moment about the hinge: positive where it deflects the panel further
  T bending{};  ///< moment about the line along x through the frame's point: of the root

  constexpr const T& operator[](std::size_t i) const { return i == 0 ? normal : i == 1 ? hinge : bending; }
};
inline constexpr std::array<std::string_view, 3> panel_load_names = {"CNp", "Ch", "Cb"};

/// From loads about the moment centre of the reference. The normal force acts -hinge / normal lengths aft of
/// the hinge line, across it, and bending / normal lengths outboard of the frame's point.
template <class T>
PanelLoads<T> panel_loads(const CoefficientsOf<T>& loads, const PanelFrame& frame,
                          const ReferenceSettings& reference) {
  const Vec3 offset = 1 / reference.length * (frame.point - reference.moment_center);
  const auto moved = moment_transfer(loads, offset);
  return {dot(frame.normal, moved.force()), dot(frame.axis, moved.moment()),
          norm(frame.normal) * moved.moment().x};
}

}  // namespace alphadot
