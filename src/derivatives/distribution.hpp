// Where along a body or a panel its loads and their derivatives sit.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/coefficients.hpp"
#include "analysis/table.hpp"
#include "core/communicator.hpp"
#include "partition/subdomain.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// Slices of equal width across a direction through the walls of some patches. The load of a face belongs to
/// the slices in proportion to its area in each, so that slices add up to the whole to round-off.
class Slices {
 public:
  /// `patches`: by their number. From end to end of them; `direction` is a unit vector. Collective.
  Slices(const Subdomain& domain, std::span<const std::size_t> patches, const Vec3& origin,
         const Vec3& direction, int count, const Communicator& comm);

  /// Distances from the origin along the direction, [slices + 1].
  const std::vector<Real>& ends() const { return ends_; }
  /// [slices] of the loads of faces, [boundary_faces], over all ranks. Collective.
  std::vector<Load> of(std::span<const Load> faces) const;

 private:
  const Subdomain& domain_;
  const Communicator& comm_;
  std::vector<bool> is_counted_;  // [patches]
  Vec3 origin_, direction_;
  std::vector<Real> ends_;
};

/// What slices hold of some quantities.
struct Distribution {
  std::string of;          ///< "total", a component, or the control whose panel it is
  std::vector<Real> ends;  ///< [slices + 1]
  std::vector<std::pair<std::string, std::vector<Real>>> quantities;  ///< by the quantity's name, [slices]
};

/// Comment lines with the head and `note`, a header and a line for each quantity and slice: its ends,
/// `along`_from and `along`_to, what it holds per unit of length, and the sum of all up to its end.
/// Quantities that are zero everywhere are left out.
std::string distribution_csv(std::span<const Distribution> distributions, const std::string& along,
                             const std::string& note, const TableHead& head);

}  // namespace alphadot
