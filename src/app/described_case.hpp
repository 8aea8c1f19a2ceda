// A description of a missile in place of a case file.
#pragma once

#include "app/verbs.hpp"

namespace alphadot {

/// Where the case file is a description (missile.toml, a rocket's design or a body's surface), has it meshed,
/// unless that was done before, and puts the case that came of it in its place. The override mesh.level,
/// "coarse" unless given, chooses the mesh, freestream.mach must be in the description's range. Collective.
/// Throws InputError where there is no mesh; what is wrong has then been printed.
void mesh_description(CaseArguments& arguments, const Communicator& comm);

}  // namespace alphadot
