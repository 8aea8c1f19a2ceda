// The parts of a VTKHDF file that follow from its size alone.
#pragma once

#include "io/hdf5.hpp"

namespace alphadot {

inline constexpr std::uint8_t vtk_triangle = 5, vtk_tetra = 10;

/// Makes the group VTKHDF of an UnstructuredGrid (version 1.0, one piece), with a group CellData inside.
hdf5::Group create_vtk_group(const hdf5::Group& file);

/// The sizes, Offsets and Types of a grid of equal cells.
void write_vtk_sizes(const hdf5::Group& vtk, GlobalIndex points, GlobalIndex cells, int corners_per_cell,
                     std::uint8_t vtk_type);

}  // namespace alphadot
