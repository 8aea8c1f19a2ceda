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
#include "partition/point_sums.hpp"

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

  /// Into CellData or PointData, which has so many entries.
  void write_fields(const std::string& group, const std::vector<VtkField>& fields, std::size_t entries) {
    const auto needed = [&](const VtkField& field) {
      return entries * static_cast<std::size_t>(field.components);
    };
    comm_.on_all([&] {
      for (const auto& field : fields)
        if (field.values.size() < needed(field))
          throw std::logic_error("too few values in field " + field.name);
    });
    for (const auto& field : fields)
      write_floats(group + "/" + field.name, field.values.first(needed(field)),
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

  /// Texts that ParaView lists with the field data.
  void write_names(const std::string& name, const std::vector<std::string>& names) {
    comm_.on_root([&] { file_->group("VTKHDF/FieldData").write_texts(name, names); });
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

/// What is summed up at a point of a surface.
struct PointSum {
  std::array<Real, 3> values;  ///< times areas
  Real area;

  PointSum& operator+=(const PointSum& b) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += b.values[i];
    area += b.area;
    return *this;
  }
};

/// This rank's faces of some patches, with the points around them.
class SurfacePart {
 public:
  SurfacePart(const Subdomain& domain, std::span<const std::size_t> patches) : domain_(domain) {
    std::vector<bool> is_shown(domain.patch_names.size(), patches.empty());
    for (const auto patch : patches) is_shown[patch] = true;
    std::vector<Index> known(domain.points.size(), -1);
    for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
      const auto& face = domain.boundary_faces[i];
      if (!is_shown[static_cast<std::size_t>(face.patch)]) continue;
      faces_.push_back(i);
      patches_.push_back(face.patch);
      for (const Index point : face.points) {
        auto& number = known[static_cast<std::size_t>(point)];
        if (number < 0) {
          number = static_cast<Index>(points_.size());
          points_.push_back(domain.points[static_cast<std::size_t>(point)]);
          ids_.push_back(domain.point_ids[static_cast<std::size_t>(point)]);
        }
        corners_.push_back(number);
      }
    }
  }

  std::span<const Vec3> points() const { return points_; }
  std::span<const Index> corners() const { return corners_; }
  std::span<const std::int32_t> patches() const { return patches_; }

  /// [faces][components] of a field on all boundary faces.
  std::vector<Real> on_faces(const VtkField& field) const {
    const auto width = static_cast<std::size_t>(field.components);
    if (field.values.size() < width * domain_.boundary_faces.size())
      throw std::logic_error("too few values in field " + field.name);
    std::vector<Real> out;
    out.reserve(width * faces_.size());
    for (const auto face : faces_)
      for (std::size_t c = 0; c < width; ++c) out.push_back(field.values[width * face + c]);
    return out;
  }

  /// [points][components] the mean over the faces around each, by area. Collective.
  std::vector<Real> at_points(const VtkField& field, const Communicator& comm) const {
    const auto width = static_cast<std::size_t>(field.components);
    std::vector<PointSum> parts(points_.size(), PointSum{});
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const auto face = faces_[i / 3];
      PointSum here{.values = {}, .area = norm(domain_.boundary_normal[face])};
      for (std::size_t c = 0; c < width; ++c) here.values[c] = here.area * field.values[width * face + c];
      parts[static_cast<std::size_t>(corners_[i])] += here;
    }
    std::vector<Real> out;
    out.reserve(width * parts.size());
    for (const auto& [values, area] : sum_at_points<PointSum>(ids_, parts, comm))
      for (std::size_t c = 0; c < width; ++c) out.push_back(values[c] / area);
    return out;
  }

 private:
  const Subdomain& domain_;
  std::vector<std::size_t> faces_;  // of Subdomain::boundary_faces
  std::vector<std::int32_t> patches_;
  std::vector<Vec3> points_;
  std::vector<GlobalIndex> ids_;  // of the points
  std::vector<Index> corners_;    // [faces][3] into the points
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
  file.write_fields("CellData", fields, cells);
  file.commit();
}

void write_surface(const std::string& path, const Subdomain& domain, const std::vector<VtkField>& fields,
                   const Origin& origin, const Communicator& comm, std::span<const std::size_t> patches) {
  const SurfacePart part(domain, patches);
  std::vector<std::vector<Real>> on_faces, at_points;
  std::vector<VtkField> face_fields, point_fields;
  for (const auto& field : fields) {
    on_faces.push_back(part.on_faces(field));
    at_points.push_back(part.at_points(field, comm));
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    face_fields.push_back(fields[i].with(on_faces[i]));
    point_fields.push_back(fields[i].with(at_points[i]));
  }
  std::string names;
  for (const auto& name : domain.patch_names) names += name + "\n";

  VtkHdfFile file(path, origin, comm);
  file.write_grid(
      {.points = part.points(), .corners = part.corners(), .corners_per_cell = 3, .vtk_type = vtk_triangle});
  file.write_values<std::int32_t>("CellData/patch", part.patches(), 0);
  file.set_attribute("CellData/patch", "names", names);
  file.write_names("patch_names", domain.patch_names);
  file.write_fields("CellData", face_fields, part.patches().size());
  file.write_fields("PointData", point_fields, part.points().size());
  file.commit();
}

}  // namespace alphadot
