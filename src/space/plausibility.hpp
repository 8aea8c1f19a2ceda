// Whether a mesh is what its case says: what is wrong, and what is improbable.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "motion/flight_condition.hpp"
#include "space/configuration.hpp"

namespace alphadot {

/// Where the improbable begins.
namespace plausible {

/// Body in reference lengths: a missile is up to 30 diameters long, a body of 1 to 5 chords' length. Ten
/// times as much on either side still leaves millimetres taken for metres outside.
inline constexpr Real shortest_body = 0.02, longest_body = 200;
/// Reference area over the largest projection of the walls. Frontal, base, planform and side areas of one
/// body lie within a factor of 50; wrong units are a factor of 100 at least for centimetres, squared.
inline constexpr Real smallest_area = 1e-3, largest_area = 1e3;
/// By which the area of a section may differ from its planform, as of one that is turned or has a gap.
inline constexpr Real planform_share = 0.05;
/// Of the moment centre from the body's box, in body lengths: it is on the body or near it, and never farther
/// than a body is long but by a mistake.
inline constexpr Real farthest_center = 3;
/// Share of the walls' frontal projection that may look aft in a supersonic stream. Behind a blunt base the
/// scheme's own dissipation sets the pressure; less than this is the edge of a fin.
inline constexpr Real aft_share = 0.02;
inline constexpr Real supersonic_mach = 1.2;
/// Of a jet's area, what may look ahead: of a base that is not quite plane, little.
inline constexpr Real fore_share = 0.1;
/// Degrees of a motion; and reduced frequency times body length in reference lengths, from which on the
/// stream passes less than a third of the body in a period.
inline constexpr Real largest_amplitude = 7, largest_frequency = 10;
/// Below this angle between faces, and above this aspect ratio and step in volume, gradients lose their
/// accuracy; generators' own optimisers leave nothing like it.
inline constexpr Real smallest_angle = 1;
inline constexpr Real largest_aspect_ratio = 100, largest_volume_ratio = 1000;

}  // namespace plausible

struct Findings {
  std::vector<Problem> problems;      ///< the case is not what the mesh is: its numbers would be wrong
  std::vector<std::string> warnings;  ///< it may be meant so
};

/// Compares. `patch_names`, `kinds`: of the mesh's patches; `scale`: its units in those of `flight`; `file`:
/// of the case, for messages. Coordinates in the messages are those of the mesh file.
Findings judge(const Configuration& configuration, std::span<const std::string> patch_names,
               std::span<const BoundaryKind> kinds, const FlightCondition& flight, Real scale,
               const std::string& file);

}  // namespace alphadot
