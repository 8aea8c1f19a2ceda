// What a mesh is as a configuration in a stream: where its body and its far field are, what it is cut by.
#pragma once

#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "euler/kinds.hpp"
#include "motion/flight_condition.hpp"
#include "partition/box.hpp"
#include "partition/quality.hpp"
#include "partition/regions.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// One of the planes that a symmetry patch consists of.
struct SymmetryPlane {
  Index patch = 0;         ///< index into Subdomain::patch_names
  Vec3 normal;             ///< of unit length, out of the flow
  Real offset = 0;         ///< normal . x of its points
  bool cuts_body = false;  ///< walls end in it
};

/// A side of the mesh along the x axis in which the body ends though no symmetry is imposed there.
struct OpenSide {
  Index patch = 0;      ///< index into Subdomain::patch_names
  SymmetryPlane plane;  ///< what the side would be a plane of
};

/// A region of cells and the patches around it.
struct RegionFacts {
  Region region;
  bool has_far_field = false;
  std::vector<Index> patches;  ///< ascending
};

/// Walls of one patch.
struct WettedWall {
  Real area = 0;             ///< none where the patch is no wall
  Real first = 0, last = 0;  ///< x between which it lies
};

/// Facts about a mesh and the case that names its patches. Lengths are in reference lengths and areas in
/// reference areas, both of the whole configuration: a half model's are completed by its mirror image.
/// Coordinates of regions, planes and cells are those of the subdomain. All are the same at any number of
/// ranks, sums but for round-off, and in any unit of length.
struct Configuration {
  std::vector<RegionFacts> regions;  ///< the largest ones, at most `most_regions`
  GlobalIndex region_count = 0;
  Box domain;             ///< around all points
  bool has_body = false;  ///< is any patch a wall? If not, what follows about walls is zero
  Box body;               ///< around all walls
  Real body_length = 0;   ///< the longest side of that box
  Real wall_area = 0;
  Vec3 projected_area;            ///< of the walls along x, y, z; parts behind each other count each
  Vec3 net_area;                  ///< sum of the walls' area vectors out of the body: zero when they close it
  std::vector<Real> aft_area;     ///< [patches] of wall faces within `aft_angle` of looking aft
  std::vector<WettedWall> walls;  ///< [patches]
  Real base_area = 0;             ///< of jets, what they show to the stream from behind
  std::vector<Real> fore_share;   ///< [patches] of a jet's area, what looks ahead
  /// How unlike the walls' lower half (z below the moment centre) is to the upper one, from 0 for mirror
  /// images to 1: of the surface, of its triangles, and of the cells all around.
  Real surface_asymmetry = 0, triangle_asymmetry = 0, cell_asymmetry = 0;

  Real tolerance = 0;  ///< within which points are taken to lie on a plane; in the subdomain's unit
  std::vector<SymmetryPlane> planes;
  std::vector<Index> curved_patches;  ///< symmetry patches with more than `most_planes` planes
  std::vector<OpenSide> open_sides;
  bool is_section = false;  ///< the body reaches from one symmetry plane to a parallel one

  Real far_field_distance = 0;  ///< from the body's box to the nearest point of the far field
  /// At subsonic speeds, the distance of the far field over what leaves the loads alone. At supersonic ones,
  /// how far behind the nose the foremost wave arrives that the body sends out and the far field may send
  /// back, over the length that it then still has to miss; infinite when no wave comes back.
  Real far_field_ratio = 0;
  MeshQuality quality;

  static constexpr std::size_t most_regions = 5, most_planes = 8;
  static constexpr Real aft_angle = 20;  ///< degrees
};

/// Distance in body lengths from which on a subsonic far field leaves the loads alone. The stream that it
/// imposes lacks the downwash of the body's lift: of a wing at distance R, of area S = L^2, the share
/// CL_alpha S / (8 pi R^2), or 0.2 % at 10 L; of a section the share cl_alpha c / (4 pi R), or 0.5 % at 100
/// c. Disturbances reach farther aside at higher Mach numbers, by Prandtl and Glauert's 1 / sqrt(1 - M^2).
Real needed_far_field_distance(Real mach, bool is_section);

/// Looks at a mesh. `kinds`: of every patch. Collective; below 1 us a cell.
Configuration survey(const Subdomain& domain, std::span<const BoundaryKind> kinds,
                     const FlightCondition& settings, const Communicator& comm);

}  // namespace alphadot
