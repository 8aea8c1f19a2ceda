// The transpose of the derivative of residual and loads by the points of the mesh.
#pragma once

#include <span>
#include <vector>

#include "linear/linearisation.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// (dR/dX)^T adjoint + (dloads/dX)^T weights at a held flow, [points]: what moving each point of the mesh by
/// a unit does to  adjoint . R + sum of weight . load. This rank's part, of its own rows of R and its own
/// walls; the product with a displacement of all points, summed over ranks, is the whole. Area vectors,
/// centroids, volumes, gradients and the limiter follow the points; limits for positivity are held, as in
/// the tangent.
///
/// With A^T psi = dJ/dW the sensitivity of J to the shape is that of adjoint = -psi (discrete, for this mesh:
/// points inside count as well). Fluxes are differentiated by central differences in the area vector, to
/// about ten digits; 1 to 2 times the time of a residual. Exchanges halos.
std::vector<Vec3> shape_transpose(const Linearisation& linearisation, FlowField<Real>& flow,
                                  std::span<const Conserved<Real>> adjoint, std::span<const Load> weights,
                                  const Vec3& moment_center);

}  // namespace alphadot
