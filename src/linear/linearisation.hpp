// The second-order residual's derivatives about one flow, where it is not linear.
#pragma once

#include <array>
#include <vector>

#include "space/residual.hpp"

namespace alphadot {

/// Derivatives of what the residual does to its numbers beyond sums: limiter, fluxes, boundary conditions.
/// Each is differentiated once, exactly, by dual numbers; the tangent applies them to as many changes of the
/// flow as there are. 1.3 kB a cell.
class Linearisation {
 public:
  /// 5 x 5, column by column.
  using Matrix = std::array<Real, 25>;

  /// Area times the flux's derivatives by the states on both sides and by the speed of the face.
  struct Face {
    Matrix left, right;
    Five<Real> speed;
    Real scaling;  ///< of the reconstruction for positivity, held
  };
  /// The same of a boundary face, by the state inside, the speed of the face and the wind.
  struct BoundaryFace {
    Matrix inside;
    Five<Real> speed;
    std::array<Five<Real>, 3> wind;
    Five<Real> pressure;  ///< of boundary_pressure() by the state inside
    Real pressure_by_speed;
    Real scaling;
  };

  /// Of a face whose wall has turned, by the state that its cell carries to where the wall is and the speed
  /// of the wall there; its boundary face has the rest.
  struct TurnedFace {
    Matrix there;
    Five<Real> speed;
    Five<Real> pressure;
    Real pressure_by_speed;
    Real scaling;
  };

  /// About a flow and its reconstruction, the ghosts of both current; a limiter frozen in it stays so. Refers
  /// to the flow.
  Linearisation(const Discretization& discretization, const Communicator& comm, const FlowField<Real>& flow,
                const Reconstruction<Real>& reconstruction, const Conditions<Real>& conditions);

  /// From now on the limiter's factors stay what they are at this flow.
  void hold_limiter();

  const Discretization& discretization() const { return discretization_; }
  const Communicator& communicator() const { return comm_; }
  const FlowField<Real>& flow() const { return flow_; }
  const Conditions<Real>& conditions() const { return conditions_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<BoundaryFace>& boundary_faces() const { return boundary_faces_; }
  /// In the order of Discretization::turned_walls().
  const std::vector<TurnedFace>& turned_faces() const { return turned_faces_; }
  const LimiterSlopes& limiter_slopes() const { return slopes_; }
  std::size_t bytes() const;

 private:
  void differentiate_faces(const Reconstruction<Real>& reconstruction);
  void differentiate_boundary(const Reconstruction<Real>& reconstruction);
  void differentiate_turned(const Reconstruction<Real>& reconstruction);

  const Discretization& discretization_;
  const Communicator& comm_;
  const FlowField<Real>& flow_;
  Conditions<Real> conditions_;
  LimiterSlopes slopes_;
  std::vector<Face> faces_;
  std::vector<BoundaryFace> boundary_faces_;
  std::vector<TurnedFace> turned_faces_;
};

}  // namespace alphadot
