#include "space/configuration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "motion/motion.hpp"

namespace alphadot {

namespace {

constexpr Real infinite = std::numeric_limits<Real>::infinity();

/// Around the boxes of all ranks.
Box over_ranks(const Box& box, const Communicator& comm) {
  std::array<Real, 6> corners{box.lower.x,  box.lower.y,  box.lower.z,
                              -box.upper.x, -box.upper.y, -box.upper.z};
  comm.min(std::span<Real>(corners));
  return {{corners[0], corners[1], corners[2]}, {-corners[3], -corners[4], -corners[5]}};
}

Real distance(const Vec3& at, const Box& box) {
  Vec3 outside;
  for (int d = 0; d < 3; ++d) outside[d] = std::max({box.lower[d] - at[d], at[d] - box.upper[d], 0.0});
  return norm(outside);
}

/// Looks at one rank's share; every member function is collective.
class Surveyor {
 public:
  Surveyor(const Subdomain& domain, std::span<const BoundaryKind> kinds, const FlightCondition& settings,
           const Communicator& comm)
      : domain_(domain), kinds_(kinds), settings_(settings), comm_(comm) {}

  Configuration look() {
    find_extent();
    look_at_regions();
    look_at_walls();
    look_at_jets();
    look_at_cells();
    find_planes();
    find_open_sides();
    look_at_far_field();
    out_.quality = mesh_quality(domain_, comm_);
    to_reference_lengths();
    return out_;
  }

 private:
  /// Calls `act(face)` for this rank's boundary faces of a kind.
  template <class Act>
  void for_each_face(BoundaryKind kind, Act&& act) const {
    for (std::size_t face = 0; face < domain_.boundary_faces.size(); ++face)
      if (kinds_[domain_.boundary_faces[face].patch] == kind) act(face);
  }

  std::array<Vec3, 3> corners(std::size_t face) const {
    const auto& points = domain_.boundary_faces[face].points;
    return {domain_.points[points[0]], domain_.points[points[1]], domain_.points[points[2]]};
  }

  void find_extent() {
    Box box = empty_box();
    for (Index point = 0; point < domain_.owned_points; ++point) extend(box, domain_.points[point]);
    out_.domain = over_ranks(box, comm_);
    Real farthest = 0;
    for (int d = 0; d < 3; ++d)
      farthest = std::max({farthest, std::abs(out_.domain.lower[d]), std::abs(out_.domain.upper[d])});
    // Generators place points on planes to some digits of the model's size, files keep some of the
    // coordinates.
    out_.tolerance = 1e-6 * norm(out_.domain.upper - out_.domain.lower) + 1e-7 * farthest;
  }

  void look_at_regions() {
    const auto regions = find_regions(domain_, comm_);
    const std::size_t listed = std::min(regions.all.size(), Configuration::most_regions);
    const std::size_t patches = domain_.patch_names.size();
    std::vector<GlobalIndex> faces(listed * patches, 0);
    for (const auto& face : domain_.boundary_faces) {
      const auto region = static_cast<std::size_t>(regions.of_cell[face.cell]);
      if (region < listed) ++faces[region * patches + static_cast<std::size_t>(face.patch)];
    }
    comm_.sum(std::span<GlobalIndex>(faces));
    out_.region_count = static_cast<GlobalIndex>(regions.all.size());
    for (std::size_t region = 0; region < listed; ++region) {
      RegionFacts facts{regions.all[region], false, {}};
      for (std::size_t patch = 0; patch < patches; ++patch) {
        if (faces[region * patches + patch] == 0) continue;
        facts.patches.push_back(static_cast<Index>(patch));
        facts.has_far_field |= kinds_[patch] == BoundaryKind::farfield;
      }
      out_.regions.push_back(std::move(facts));
    }
  }

  void look_at_walls() {
    const std::size_t patches = domain_.patch_names.size();
    const Real aft = std::cos(Configuration::aft_angle * radians_per_degree);
    const Real center = settings_.reference.moment_center.z;
    Box box = empty_box();
    // faces, area, area towards +x +y +z, towards -x -y -z, area times z and |z|, z and |z|, then by patch
    // what looks aft and all
    std::vector<Real> sums(12 + 2 * patches, 0), first(patches, infinite), last(patches, infinite);
    for_each_face(BoundaryKind::wall, [&](std::size_t face) {
      const auto patch = static_cast<std::size_t>(domain_.boundary_faces[face].patch);
      for (const Vec3& corner : corners(face)) {
        extend(box, corner);
        first[patch] = std::min(first[patch], corner.x);
        last[patch] = std::min(last[patch], -corner.x);
      }
      const Vec3 out_of_body = -domain_.boundary_normal[face];
      const Real area = norm(out_of_body), z = domain_.boundary_center[face].z - center;
      sums[0] += 1;
      sums[1] += area;
      for (int d = 0; d < 3; ++d) {
        sums[static_cast<std::size_t>(2 + d)] += std::max(out_of_body[d], 0.0);
        sums[static_cast<std::size_t>(5 + d)] += std::max(-out_of_body[d], 0.0);
      }
      sums[8] += area * z;
      sums[9] += area * std::abs(z);
      sums[10] += z;
      sums[11] += std::abs(z);
      if (out_of_body.x > aft * area) sums[12 + patch] += area;
      sums[12 + patches + patch] += area;
    });
    comm_.sum(std::span<Real>(sums));
    comm_.min(std::span<Real>(first));
    comm_.min(std::span<Real>(last));
    out_.walls.resize(patches);
    out_.aft_area.assign(patches, 0);
    out_.has_body = sums[0] > 0;
    if (!out_.has_body) return;

    out_.body = over_ranks(box, comm_);
    // The mirror image doubles everything but what is seen from the side, where it stands behind.
    const Real mirror = settings_.reference.half_model ? 2 : 1;
    out_.wall_area = mirror * sums[1];
    for (int d = 0; d < 3; ++d) {
      const Real positive = sums[static_cast<std::size_t>(2 + d)],
                 negative = sums[static_cast<std::size_t>(5 + d)];
      out_.projected_area[d] = (d == 1 ? 1 : mirror) * std::max(positive, negative);
      out_.net_area[d] = d == 1 && mirror == 2 ? 0 : mirror * (positive - negative);
    }
    for (std::size_t patch = 0; patch < patches; ++patch) out_.aft_area[patch] = mirror * sums[12 + patch];
    for (std::size_t patch = 0; patch < patches; ++patch)
      if (const Real area = sums[12 + patches + patch]; area > 0)
        out_.walls[patch] = {mirror * area, first[patch], -last[patch]};
    out_.surface_asymmetry = share(sums[8], sums[9]);
    out_.triangle_asymmetry = share(sums[10], sums[11]);
    if (mirror == 2) {
      out_.body.lower.y = std::min(out_.body.lower.y, -out_.body.upper.y);
      out_.body.upper.y = std::max(out_.body.upper.y, -out_.body.lower.y);
    }
    for (int d = 0; d < 3; ++d)
      out_.body_length = std::max(out_.body_length, out_.body.upper[d] - out_.body.lower[d]);
  }

  void look_at_jets() {
    const std::size_t patches = domain_.patch_names.size();
    std::vector<Real> sums(2 * patches + 1, 0);  // what looks ahead and all, by patch; what shows aft
    for_each_face(BoundaryKind::jet, [&](std::size_t face) {
      const Vec3 out_of_body = -domain_.boundary_normal[face];
      const auto patch = static_cast<std::size_t>(domain_.boundary_faces[face].patch);
      if (out_of_body.x < 0) sums[patch] += norm(out_of_body);
      sums[patches + patch] += norm(out_of_body);
      sums[2 * patches] += std::max(out_of_body.x, 0.0);
    });
    comm_.sum(std::span<Real>(sums));
    out_.base_area = (settings_.reference.half_model ? 2 : 1) * sums[2 * patches];
    for (std::size_t patch = 0; patch < patches; ++patch)
      out_.fore_share.push_back(share(sums[patch], sums[patches + patch]));
  }

  static Real share(Real sum, Real magnitude) { return magnitude > 0 ? std::abs(sum) / magnitude : 0; }

  void look_at_cells() {
    std::array<Real, 2> sums{};
    for (Index cell = 0; cell < domain_.owned_cells; ++cell) {
      const Real z = domain_.center[cell].z - settings_.reference.moment_center.z;
      sums[0] += z;
      sums[1] += std::abs(z);
    }
    comm_.sum(std::span<Real>(sums));
    out_.cell_asymmetry = share(sums[0], sums[1]);
  }

  /// Plane after plane of a patch, each that of the largest triangle which lies on none before.
  void find_planes() {
    for (std::size_t patch = 0; patch < kinds_.size(); ++patch) {
      if (kinds_[patch] != BoundaryKind::symmetry) continue;
      std::vector<std::size_t> left;
      for_each_face(BoundaryKind::symmetry, [&](std::size_t face) {
        if (domain_.boundary_faces[face].patch == static_cast<Index>(patch)) left.push_back(face);
      });
      std::size_t planes = 0;
      while (comm_.any(!left.empty())) {
        if (planes++ == Configuration::most_planes) {
          out_.curved_patches.push_back(static_cast<Index>(patch));
          break;
        }
        auto plane = plane_of_largest(left);
        plane.patch = static_cast<Index>(patch);
        plane.cuts_body = cuts_body(plane);
        out_.planes.push_back(plane);
        std::erase_if(left, [&](std::size_t face) {
          const Vec3 normal = domain_.boundary_normal[face];
          return dot(normal, plane.normal) > 0.9 * norm(normal) &&
                 std::ranges::all_of(corners(face), [&](const Vec3& at) { return is_on(plane, at); });
        });
      }
    }
    for (const auto& a : out_.planes)
      for (const auto& b : out_.planes)
        out_.is_section |= a.cuts_body && b.cuts_body && dot(a.normal, b.normal) < -0.999;
  }

  /// Sides of the box around all points: all of the mesh lies on one side of each. Bodies are the walls of
  /// patches that do not lie in any, as walls of a tunnel do.
  void find_open_sides() {
    std::vector<SymmetryPlane> sides;
    for (int d = 0; d < 3; ++d)
      for (const Real sign : {-1.0, 1.0}) {
        auto& side = sides.emplace_back();
        side.normal[d] = sign;
        side.offset = sign < 0 ? -out_.domain.lower[d] : out_.domain.upper[d];
      }
    const std::size_t patches = kinds_.size();
    std::vector<Real> lies_in_side(sides.size() * patches, 0), ends_in_side(sides.size() * patches, 0);
    for (std::size_t side = 0; side < sides.size(); ++side)
      for (std::size_t face = 0; face < domain_.boundary_faces.size(); ++face) {
        const std::size_t at = side * patches + static_cast<std::size_t>(domain_.boundary_faces[face].patch);
        const auto corners_there =
            std::ranges::count_if(corners(face), [&](const Vec3& x) { return is_on(sides[side], x); });
        const Vec3& normal = domain_.boundary_normal[face];
        if (corners_there == 3 && dot(normal, sides[side].normal) > 0.9999 * norm(normal))
          lies_in_side[at] = 1;
        if (corners_there == 2) ends_in_side[at] = 1;
      }
    comm_.sum(std::span<Real>(lies_in_side));
    comm_.sum(std::span<Real>(ends_in_side));
    const auto is_body = [&](std::size_t patch) {
      bool out = kinds_[patch] == BoundaryKind::wall;
      for (std::size_t side = 0; side < sides.size(); ++side)
        out &= lies_in_side[side * patches + patch] == 0;
      return out;
    };
    for (std::size_t side = 0; side < sides.size(); ++side) {
      bool has_end = false;
      for (std::size_t patch = 0; patch < patches; ++patch)
        has_end |= is_body(patch) && ends_in_side[side * patches + patch] > 0;
      if (!has_end || sides[side].normal.x != 0) continue;
      for (std::size_t patch = 0; patch < patches; ++patch)
        if (lies_in_side[side * patches + patch] > 0 && kinds_[patch] != BoundaryKind::symmetry)
          out_.open_sides.push_back({static_cast<Index>(patch), sides[side]});
    }
  }

  bool is_on(const SymmetryPlane& plane, const Vec3& at) const {
    return std::abs(dot(plane.normal, at) - plane.offset) <= out_.tolerance;
  }

  /// The plane of the largest of these triangles on any rank; of equal ones that with the smallest id.
  SymmetryPlane plane_of_largest(std::span<const std::size_t> faces) const {
    Real area = 0;
    for (const std::size_t face : faces) area = std::max(area, norm(domain_.boundary_normal[face]));
    area = comm_.max(area);
    Real id = infinite;  // exact as a real number up to 2^53
    std::array<Real, 6> found;
    found.fill(infinite);
    for (const std::size_t face : faces) {
      const auto face_id = static_cast<Real>(domain_.boundary_faces[face].id);
      if (norm(domain_.boundary_normal[face]) != area || face_id > id) continue;
      id = face_id;
      const Vec3 &normal = domain_.boundary_normal[face], &center = domain_.boundary_center[face];
      found = {normal.x, normal.y, normal.z, center.x, center.y, center.z};
    }
    if (id != comm_.min(id)) found.fill(infinite);
    comm_.min(std::span<Real>(found));
    SymmetryPlane out;
    out.normal = (1 / area) * Vec3{found[0], found[1], found[2]};
    // One triangle gives the direction to some digits only; planes across an axis are meant to be so.
    for (int d = 0; d < 3; ++d)
      if (std::abs(out.normal[d]) > 1 - 5e-7) {
        const Real sign = out.normal[d] > 0 ? 1 : -1;
        out.normal = {};
        out.normal[d] = sign;
      }
    out.offset = dot(out.normal, Vec3{found[3], found[4], found[5]});
    return out;
  }

  /// True when walls have edges on the plane.
  bool cuts_body(const SymmetryPlane& plane) const {
    bool out = false;
    for_each_face(BoundaryKind::wall, [&](std::size_t face) {
      out |= std::ranges::count_if(corners(face), [&](const Vec3& at) { return is_on(plane, at); }) >= 2;
    });
    return comm_.any(out);
  }

  void look_at_far_field() {
    if (!out_.has_body) return;
    Real nearest = infinite;
    for_each_face(BoundaryKind::farfield, [&](std::size_t face) {
      for (const Vec3& corner : corners(face)) nearest = std::min(nearest, distance(corner, out_.body));
      nearest = std::min(nearest, distance(domain_.boundary_center[face], out_.body));
    });
    out_.far_field_distance = comm_.min(nearest);
    const Real mach = settings_.freestream.mach;
    out_.far_field_ratio =
        mach > 1
            ? returning_wave_ratio(std::sqrt(mach * mach - 1))
            : out_.far_field_distance / (out_.body_length * needed_far_field_distance(mach, out_.is_section));
  }

  /// A place along and across the wind.
  Vec3 in_wind_axes(const Vec3& at) const {
    return {dot(wind_[0], at), dot(wind_[1], at), dot(wind_[2], at)};
  }

  /// The walls in slices across the wind, each in a box.
  std::vector<Box> wall_slices() const {
    constexpr std::size_t count = 32;
    Real begin = infinite, end = -infinite;
    for_each_face(BoundaryKind::wall, [&](std::size_t face) {
      for (const Vec3& corner : corners(face)) {
        begin = std::min(begin, dot(wind_[0], corner));
        end = std::max(end, dot(wind_[0], corner));
      }
    });
    begin = comm_.min(begin);
    end = comm_.max(end);
    const Real thickness = std::max((end - begin) / count, std::numeric_limits<Real>::min());
    std::vector<Real> numbers(4 * count, infinite);  // lower y, z and negative upper y, z of each slice
    for_each_face(BoundaryKind::wall, [&](std::size_t face) {
      Box box = empty_box();
      for (const Vec3& corner : corners(face)) extend(box, in_wind_axes(corner));
      const auto slice_of = [&](Real x) {
        return static_cast<std::size_t>(std::clamp((x - begin) / thickness, 0.0, count - 1.0));
      };
      for (std::size_t slice = slice_of(box.lower.x); slice <= slice_of(box.upper.x); ++slice) {
        const std::array<Real, 4> of_face{box.lower.y, box.lower.z, -box.upper.y, -box.upper.z};
        for (std::size_t i = 0; i < 4; ++i)
          numbers[4 * slice + i] = std::min(numbers[4 * slice + i], of_face[i]);
      }
    });
    comm_.min(std::span<Real>(numbers));
    std::vector<Box> out;
    for (std::size_t slice = 0; slice < count; ++slice) {
      const Real* n = &numbers[4 * slice];
      if (n[0] == infinite) continue;
      const Real lower = begin + static_cast<Real>(slice) * thickness;
      out.push_back({{lower, n[0], n[1]}, {lower + thickness, -n[2], -n[3]}});
    }
    return out;
  }

  /// `beta`: cotangent of the Mach angle.
  Real returning_wave_ratio(Real beta) {
    const auto& stream = settings_.freestream;
    wind_[0] = wind_velocity(1, stream.alpha * radians_per_degree, stream.beta * radians_per_degree);
    const Vec3 aside = std::abs(wind_[0].y) < 0.7 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    wind_[1] = aside - dot(aside, wind_[0]) * wind_[0];
    wind_[1] = (1 / norm(wind_[1])) * wind_[1];
    wind_[2] = cross(wind_[0], wind_[1]);
    const auto slices = wall_slices();
    const Real nose = slices.front().lower.x;
    Real ratio = infinite;
    for_each_face(BoundaryKind::farfield, [&](std::size_t face) {
      const Vec3 at = in_wind_axes(domain_.boundary_center[face]);
      // How far a Mach wave goes along the wind between the face and a slice.
      const auto run = [&](const Box& slice) {
        return beta * std::hypot(std::max({slice.lower.y - at.y, at.y - slice.upper.y, 0.0}),
                                 std::max({slice.lower.z - at.z, at.z - slice.upper.z, 0.0}));
      };
      const bool is_reached =
          std::ranges::any_of(slices, [&](const Box& slice) { return slice.lower.x + run(slice) < at.x; });
      if (!is_reached) return;
      for (const Box& slice : slices)
        ratio = std::min(ratio, (at.x + run(slice) - nose) / (slice.upper.x - nose));
    });
    return comm_.min(ratio);
  }

  void to_reference_lengths() {
    const Real length = 1 / settings_.reference.length, area = 1 / settings_.reference.area;
    for (Box* box : {&out_.domain, &out_.body}) *box = {length * box->lower, length * box->upper};
    out_.body_length *= length;
    out_.far_field_distance *= length;
    out_.wall_area *= area;
    out_.projected_area = area * out_.projected_area;
    out_.net_area = area * out_.net_area;
    for (Real& aft : out_.aft_area) aft *= area;
    for (auto& wall : out_.walls) wall = {area * wall.area, length * wall.first, length * wall.last};
    out_.base_area *= area;
  }

  const Subdomain& domain_;
  const std::span<const BoundaryKind> kinds_;
  const FlightCondition& settings_;
  const Communicator comm_;
  std::array<Vec3, 3> wind_{};  ///< unit vectors along and across the wind
  Configuration out_;
};

}  // namespace

Real needed_far_field_distance(Real mach, bool is_section) {
  constexpr Real of_wing = 10, of_section = 100, largest_mach = 0.95;
  const Real m = std::min(mach, largest_mach);
  return (is_section ? of_section : of_wing) / std::sqrt(1 - m * m);
}

Configuration survey(const Subdomain& domain, std::span<const BoundaryKind> kinds,
                     const FlightCondition& settings, const Communicator& comm) {
  return Surveyor(domain, kinds, settings, comm).look();
}

}  // namespace alphadot
