// Meshes that are made from descriptions of missiles.
#pragma once

#include "app/verbs.hpp"
#include "derivatives/case.hpp"

namespace alphadot {

/// Where the case file is a description (missile.toml, a rocket's design or a body's surface), has it meshed,
/// unless that was done before, and puts the case that came of it in its place; the override mesh.level,
/// "coarse" unless given, chooses the mesh. The Mach number of the case must be in the description's range.
/// Collective. Throws InputError where there is no mesh; what is wrong has then been printed.
void replace_description(CaseArguments& arguments, const Communicator& comm);

/// The same for a case that takes its mesh from a description (mesh.from): its mesh.file is then the one
/// made, and so are, unless the case has its own, its coarser meshes.
void make_mesh(Case& settings, const Communicator& comm);

}  // namespace alphadot
