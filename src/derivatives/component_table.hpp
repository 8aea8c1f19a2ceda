// Derivatives of components as text.
#pragma once

#include <span>
#include <string>

#include "analysis/table.hpp"
#include "derivatives/linear_derivatives.hpp"

namespace alphadot {

/// Comment lines with the head, a header, a line for each component and derivative, full precision. Of a half
/// model also what the walls of the mesh alone have, without their mirror image: its lateral loads are no
/// zeros, whose contributions to the whole are left empty.
std::string component_csv(std::span<const ComponentDerivatives> components, const TableHead& head);

}  // namespace alphadot
