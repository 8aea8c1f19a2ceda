#include "partition/subdomain.hpp"

#include <cstddef>

#include "partition/geometry.hpp"

namespace alphadot {

namespace {

template <std::size_t n>
std::array<Vec3, n> corners(const Subdomain& domain, const std::array<Index, n>& local) {
  std::array<Vec3, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = domain.points[local[i]];
  return out;
}

template <std::size_t n>
std::array<GlobalIndex, n> ids(const Subdomain& domain, const std::array<Index, n>& local) {
  std::array<GlobalIndex, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = domain.point_ids[local[i]];
  return out;
}

template <class T>
std::size_t bytes_of(const std::vector<T>& array) {
  return array.size() * sizeof(T);
}

std::size_t bytes_of(const Adjacency& rows) {
  return bytes_of(rows.begin) + bytes_of(rows.items);
}

}  // namespace

void Subdomain::update_metrics() {
  volume.resize(cell_points.size());
  center.resize(cell_points.size());
  for (std::size_t cell = 0; cell < cell_points.size(); ++cell) {
    const auto metrics =
        tetrahedron_metrics(corners(*this, cell_points[cell]), ids(*this, cell_points[cell]));
    volume[cell] = metrics.volume;
    center[cell] = metrics.center;
  }
  face_normal.resize(face_points.size());
  face_center.resize(face_points.size());
  for (std::size_t face = 0; face < face_points.size(); ++face) {
    const auto metrics = triangle_metrics(corners(*this, face_points[face]), ids(*this, face_points[face]));
    face_normal[face] = metrics.normal;
    face_center[face] = metrics.center;
  }
  boundary_normal.resize(boundary_faces.size());
  boundary_center.resize(boundary_faces.size());
  for (std::size_t face = 0; face < boundary_faces.size(); ++face) {
    const auto& points_of_face = boundary_faces[face].points;
    const auto metrics = triangle_metrics(corners(*this, points_of_face), ids(*this, points_of_face));
    boundary_normal[face] = metrics.normal;
    boundary_center[face] = metrics.center;
  }
}

std::size_t Subdomain::bytes() const {
  std::size_t sum = bytes_of(points) + bytes_of(point_ids) + bytes_of(cell_points) + bytes_of(cell_ids) +
                    bytes_of(volume) + bytes_of(center) + bytes_of(faces) + bytes_of(face_normal) +
                    bytes_of(face_center) + bytes_of(face_points) + bytes_of(boundary_faces) +
                    bytes_of(boundary_normal) + bytes_of(boundary_center) + bytes_of(cell_faces) +
                    bytes_of(point_cells) + bytes_of(neighbours);
  for (const auto& neighbour : neighbours) sum += bytes_of(neighbour.send);
  return sum;
}

}  // namespace alphadot
