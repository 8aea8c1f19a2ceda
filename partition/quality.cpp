#include "partition/quality.hpp"

#include <array>
#include <limits>
#include <span>

#include "partition/geometry.hpp"

namespace alphadot {

namespace {

/// The cell with the smallest of the values that it is shown.
class Smallest {
 public:
  void show(Real value, GlobalIndex id, const Vec3& at) {
    if (value < worst_.value || (value == worst_.value && id < worst_.id)) worst_ = {value, id, at};
  }
  /// Of all ranks. Collective.
  WorstCell over(const Communicator& comm) const {
    constexpr Real none = std::numeric_limits<Real>::infinity();
    WorstCell out;
    out.value = comm.min(worst_.value);
    // Ids are exact as real numbers up to 2^53.
    const Real id = comm.min(worst_.value == out.value ? static_cast<Real>(worst_.id) : none);
    out.id = static_cast<GlobalIndex>(id);
    const bool mine = worst_.value == out.value && worst_.id == out.id;
    std::array<Real, 3> at{none, none, none};
    if (mine) at = {worst_.at.x, worst_.at.y, worst_.at.z};
    comm.min(std::span<Real>(at));
    out.at = {at[0], at[1], at[2]};
    return out;
  }

 private:
  WorstCell worst_{std::numeric_limits<Real>::max(), GlobalIndex{1} << 53, {}};
};

/// A cell with the largest value is the one with the smallest negative.
WorstCell negative(WorstCell cell) {
  cell.value = -cell.value;
  return cell;
}

}  // namespace

MeshQuality mesh_quality(const Subdomain& domain, const Communicator& comm) {
  Smallest angle, aspect, ratio;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    std::array<Vec3, 4> points;
    std::array<GlobalIndex, 4> ids;
    for (std::size_t i = 0; i < 4; ++i) {
      points[i] = domain.points[domain.cell_points[cell][i]];
      ids[i] = domain.point_ids[domain.cell_points[cell][i]];
    }
    const auto shape = tetrahedron_shape(points, ids);
    angle.show(shape.smallest_angle, domain.cell_ids[cell], domain.center[cell]);
    aspect.show(-shape.aspect_ratio, domain.cell_ids[cell], domain.center[cell]);
    ratio.show(-1, domain.cell_ids[cell], domain.center[cell]);  // where no cell has a neighbour
  }
  for (const auto& [left, right] : domain.faces) {
    const Index small = domain.volume[left] < domain.volume[right] ? left : right,
                large = small == left ? right : left;
    ratio.show(-domain.volume[large] / domain.volume[small], domain.cell_ids[small], domain.center[small]);
  }
  return {angle.over(comm), negative(aspect.over(comm)), negative(ratio.over(comm))};
}

}  // namespace alphadot
