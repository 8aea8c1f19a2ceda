#include "io/vtkhdf_grid.hpp"

#include <algorithm>
#include <vector>

namespace alphadot {
namespace {

/// A dataset of value(0) ... value(size - 1), made in pieces.
template <class T, class Value>
void write_computed(const hdf5::Group& group, const std::string& name, GlobalIndex size, Value value) {
  constexpr GlobalIndex piece_rows = 1 << 18;
  auto target = group.create_dataset<T>(name, size);
  std::vector<T> piece;
  for (GlobalIndex first = 0; first < size; first += piece_rows) {
    piece.resize(static_cast<std::size_t>(std::min(piece_rows, size - first)));
    for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = value(first + static_cast<GlobalIndex>(i));
    target.write(first, std::span<const T>(piece));
  }
}

}  // namespace

hdf5::Group create_vtk_group(const hdf5::Group& file) {
  auto vtk = file.create_group("VTKHDF");
  vtk.set_attribute("Version", std::vector<std::int64_t>{1, 0});
  vtk.set_attribute("Type", "UnstructuredGrid");
  vtk.create_group("CellData");
  return vtk;
}

void write_vtk_sizes(const hdf5::Group& vtk, GlobalIndex points, GlobalIndex cells, int corners_per_cell,
                     std::uint8_t vtk_type) {
  vtk.write("NumberOfPoints", std::vector<std::int64_t>{points});
  vtk.write("NumberOfCells", std::vector<std::int64_t>{cells});
  vtk.write("NumberOfConnectivityIds", std::vector<std::int64_t>{cells * corners_per_cell});
  write_computed<std::int64_t>(vtk, "Offsets", cells + 1,
                               [&](GlobalIndex i) { return i * corners_per_cell; });
  write_computed<std::uint8_t>(vtk, "Types", cells, [&](GlobalIndex) { return vtk_type; });
}

}  // namespace alphadot
