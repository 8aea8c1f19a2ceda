// Pictures of the flow: VTKHDF files (version 1.0, UnstructuredGrid, one piece) that ParaView 5.10 and later
// opens.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/types.hpp"
#include "core/vec3.hpp"
#include "io/provenance.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// A named quantity on cells or faces. Refers to the values, which must live until it has been written.
struct VtkField {
  std::string name;
  int components;                ///< 1, or 3 for a vector
  std::span<const Real> values;  ///< [cells or faces][components]

  VtkField(std::string field_name, std::span<const Real> scalars)
      : name(std::move(field_name)), components(1), values(scalars) {}
  VtkField(std::string field_name, std::span<const Vec3> vectors)
      : name(std::move(field_name)),
        components(3),
        values(reinterpret_cast<const Real*>(vectors.data()), 3 * vectors.size()) {}

  /// The same quantity elsewhere.
  VtkField with(std::span<const Real> other_values) const {
    VtkField out = *this;
    out.values = other_values;
    return out;
  }
};

/// Writes the owned cells of all ranks with their fields ([owned_cells] values each, or more: ghosts are left
/// out), in the order of ranks; points on the cuts between ranks appear once a rank. Reals become 32-bit
/// floats. The origin is in the group FieldData: mach, alpha and beta as numbers, all of it as its attribute
/// "origin". Through a temporary file. Collective; every rank gives the same fields. Throws InputError on
/// every rank.
void write_flow(const std::string& path, const Subdomain& domain, const std::vector<VtkField>& fields,
                const Origin& origin, const Communicator& comm);

/// The same for the boundary faces ([boundary_faces] values in each field) of some patches, by their numbers
/// (empty: of all): on faces, and as means at points, by area, for smooth pictures. With the integer field
/// "patch" on faces: the index into Subdomain::patch_names, which are its attribute "names", one a line, and
/// FieldData/patch_names.
void write_surface(const std::string& path, const Subdomain& domain, const std::vector<VtkField>& fields,
                   const Origin& origin, const Communicator& comm, std::span<const std::size_t> patches = {});

}  // namespace alphadot
