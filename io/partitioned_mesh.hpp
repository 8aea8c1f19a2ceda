// Mesh files prepared for reading by many ranks at once (HDF5).
//
// Datasets: cells [cells x 4] point numbers, piece by piece; points [points x 3]; triangles [triangles x 3]
// with triangle_cell and triangle_patch, in the order of the cells behind them; piece_begin [pieces + 1];
// patches/0000, ...: their names. Each array carries a sum over its rows, so that no damage goes unseen.
#pragma once

#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "partition/mesh_part.hpp"
#include "partition/reorder.hpp"

namespace alphadot {

/// What is in a file before its arrays are read.
struct PartitionedMeshHeader {
  GlobalIndex cells = 0, points = 0, triangles = 0;
  std::vector<GlobalIndex> piece_begin;  ///< [pieces + 1]
  std::vector<std::string> patch_names;
  std::string hash;  ///< the mesh's identity, as Mesh::hash(): another order of cells is another mesh

  int pieces() const { return static_cast<int>(piece_begin.size()) - 1; }
};

/// True for HDF5 files, whatever their name: of the mesh formats only this one is.
bool is_hdf5(const std::string& path);
/// True for a file made by write_partitioned_mesh(), of any version.
bool is_partitioned_mesh(const std::string& path);

/// For one rank. Throws InputError.
PartitionedMeshHeader read_partitioned_mesh_header(const std::string& path);

/// Replaces the file `path`; the root writes, piece by piece. Returns the mesh's hash on every rank.
/// Collective. Throws InputError on every rank.
std::string write_partitioned_mesh(const std::string& path, const OrderedMesh& mesh,
                                   const Communicator& comm);

/// Every rank reads its own cells: the pieces in turn when the ranks divide their number, else an equal
/// stretch of the cells' order. Triangles then go to the ranks of their cells. No rank holds more than its
/// part. Collective. Throws InputError on every rank: no such mesh, damage, more ranks than cells.
MeshPart read_partitioned_mesh(const std::string& path, const Communicator& comm);

}  // namespace alphadot
