// Moment centres as a user gives them.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec3.hpp"

namespace alphadot {

/// "x" or "x,y,z" in the mesh's unit; x alone keeps the y and z of the results that it is applied to.
struct Center {
  Real x = 0;
  std::optional<std::pair<Real, Real>> yz = {};

  Vec3 of(const Vec3& own) const { return yz ? Vec3{x, yz->first, yz->second} : Vec3{x, own.y, own.z}; }
};

/// Of the command line. Throws InputError for what is none, not finite or farther away than 1e12.
Center parse_center(const std::string& text);

/// Of a file with a centre a line; what follows a # is a remark. Not collective: for one rank. Throws
/// InputError with file and line, also when there is none.
std::vector<Center> read_centers(const std::string& path);

}  // namespace alphadot
