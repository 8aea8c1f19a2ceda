#include "io/vtkhdf.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/files.hpp"
#include "io/hdf5.hpp"
#include "io/stream_to_root.hpp"
#include "io/vtkhdf_grid.hpp"

namespace alphadot {
namespace {

/// One rank's part of a grid of equal cells.
struct GridPart {
  std::span<const Vec3> points;
  std::span<const Index> corners;  ///< [cells][corners_per_cell] into `points`
  int corners_per_cell;
  std::uint8_t vtk_type;

  std::size_t cells() const { return corners.size() / static_cast<std::size_t>(corners_per_cell); }
};

/// A VTKHDF file open on the root, written by all ranks together. Every function is collective.
class VtkHdfFile {
 public:
  VtkHdfFile(const std::string& path, const Origin& origin, const Communicator& comm) : comm_(comm) {
    comm_.on_root([&] {
      replacement_.emplace(path);
      file_.emplace(hdf5::File::create(replacement_->temporary()));
      create_vtk_group(*file_);
      auto data = file_->create_group("VTKHDF/FieldData");
      data.set_attribute("origin", origin.text());
      const auto& stream = origin.freestream;
      for (const auto& [name, value] :
           {std::pair{"mach", stream.mach}, std::pair{"alpha", stream.alpha}, std::pair{"beta", stream.beta}})
        data.write(name, std::vector<Real>{value});
    });
  }

  void write_grid(const GridPart& part) {
    const GlobalIndex points_here = static_cast<GlobalIndex>(part.points.size());
    GlobalIndex first_point = 0;
    MPI_Exscan(&points_here, &first_point, 1, MPI_INT64_T, MPI_SUM, comm_.handle());  // the root keeps its 0
    std::array totals{points_here, static_cast<GlobalIndex>(part.cells())};
    comm_.sum(totals);
    const GlobalIndex points = totals[0], cells = totals[1];

    write_floats("Points", {reinterpret_cast<const Real*>(part.points.data()), 3 * part.points.size()}, 3);
    std::vector<std::int64_t> corners(part.corners.begin(), part.corners.end());
    for (auto& corner : corners) corner += first_point;
    write_values<std::int64_t>("Connectivity", corners, 0);
    comm_.on_root([&] {
      write_vtk_sizes(file_->group("VTKHDF"), points, cells, part.corners_per_cell, part.vtk_type);
    });
  }

  void write_cell_fields(const std::vector<VtkField>& fields, std::size_t cells) {
    const auto needed = [&](const VtkField& field) {
      return cells * static_cast<std::size_t>(field.components);
    };
    comm_.on_all([&] {
      for (const auto& field : fields)
        if (field.values.size() < needed(field))
          throw std::logic_error("too few values in field " + field.name);
    });
    for (const auto& field : fields)
      write_floats("CellData/" + field.name, field.values.first(needed(field)),
                   field.components == 1 ? 0 : field.components);
  }

  /// Streams the values of all ranks into a new dataset.
  template <class T>
  void write_values(const std::string& name, std::span<const T> values, GlobalIndex columns) {
    const GlobalIndex rows =
        comm_.sum(static_cast<GlobalIndex>(values.size())) / std::max<GlobalIndex>(columns, 1);
    std::optional<hdf5::Dataset> target;
    comm_.on_root([&] { target.emplace(file_->create_dataset<T>("VTKHDF/" + name, rows, columns)); });
    stream_to_root<T>(
        comm_, values,
        [&](GlobalIndex first, std::span<const T> piece) {
          target->write(first / std::max<GlobalIndex>(columns, 1), piece);
        },
        piece_rows * std::max<GlobalIndex>(columns, 1));
  }

  void set_attribute(const std::string& dataset, const std::string& name, const std::string& text) {
    comm_.on_root([&] { file_->dataset("VTKHDF/" + dataset).set_attribute(name, text); });
  }

  void commit() {
    comm_.on_root([&] {
      file_->close();
      replacement_->commit();
    });
  }

 private:
  static constexpr GlobalIndex piece_rows = 1 << 18;

  void write_floats(const std::string& name, std::span<const Real> values, GlobalIndex columns) {
    write_values<float>(name, std::vector<float>(values.begin(), values.end()), columns);
  }

  const Communicator& comm_;
  std::optional<Replacement> replacement_;  ///< on the root
  std::optional<hdf5::File> file_;          ///< on the root; closed before the replacement is given up
};

}  // namespace

void write_flow(const std::string& path, const Subdomain& domain, const std::vector<VtkField>& fields,
                const Origin& origin, const Communicator& comm) {
  const auto cells = static_cast<std::size_t>(domain.owned_cells);
  VtkHdfFile file(path, origin, comm);
  file.write_grid({.points = std::span(domain.points).first(static_cast<std::size_t>(domain.owned_points)),
                   .corners = {domain.cell_points.data()->data(), 4 * cells},
                   .corners_per_cell = 4,
                   .vtk_type = vtk_tetra});
  file.write_cell_fields(fields, cells);
  file.commit();
}

void write_surface(const std::string& path, const Subdomain& domain, const std::vector<VtkField>& fields,
                   const Origin& origin, const Communicator& comm) {
  std::vector<Index> surface_id(domain.points.size(), -1), corners;
  std::vector<Vec3> points;
  std::vector<std::int32_t> patches;
  for (const auto& face : domain.boundary_faces) {
    for (const Index point : face.points) {
      auto& id = surface_id[static_cast<std::size_t>(point)];
      if (id < 0) {
        id = static_cast<Index>(points.size());
        points.push_back(domain.points[static_cast<std::size_t>(point)]);
      }
      corners.push_back(id);
    }
    patches.push_back(face.patch);
  }
  std::string names;
  for (const auto& name : domain.patch_names) names += name + "\n";

  VtkHdfFile file(path, origin, comm);
  file.write_grid({.points = points, .corners = corners, .corners_per_cell = 3, .vtk_type = vtk_triangle});
  file.write_values<std::int32_t>("CellData/patch", patches, 0);
  file.set_attribute("CellData/patch", "names", names);
  file.write_cell_fields(fields, patches.size());
  file.commit();
}

}  // namespace alphadot
