// Meshes that are made from descriptions of missiles.
#pragma once

#include "app/verbs.hpp"

namespace alphadot {

/// Where the case file is a description (missile.toml, a rocket's design or a body's surface), has it meshed,
/// unless that was done before, and puts the case that came of it in its place; the override mesh.level,
/// "coarse" unless given, chooses the mesh. Where the case takes its mesh from a description (mesh.from), has
/// that meshed likewise, and adds mesh.file and, unless the case has its own, derivatives.coarser_meshes to
/// the overrides. The Mach number of the case must be in the description's range. Collective. Throws
/// InputError where there is no mesh; what is wrong has then been printed.
void mesh_description(CaseArguments& arguments, const Communicator& comm);

}  // namespace alphadot
