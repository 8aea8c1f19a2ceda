// Faces of walls that look aft, as a patch of their own.
#pragma once

#include <string>

#include "core/types.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// Whether the body's outward normal at a boundary face, whose area vector points out of the flow, lies
/// within 45 degrees of the x axis.
bool looks_aft(const Vec3& area);

/// "fin_aft" of "fin".
std::string aft_name(const std::string& patch);

/// Takes the faces of a patch, one of the domain's, that look aft out of it and makes them the last patch,
/// aft_name(). Returns their area on this rank. To be called on every rank alike.
Real part_aft_faces(Subdomain& domain, const std::string& name);

}  // namespace alphadot
