// Flops of the residual, counted by the templates that it is made of.
#pragma once

#include "bench/counted.hpp"
#include "space/conditions.hpp"
#include "space/discretization.hpp"
#include "space/flow_field.hpp"

namespace alphadot {

/// Operations on flow variables in one second-order evaluation on this rank. Geometry (normals, arms: about
/// 60 operations a cell) and limiter (about 300) are not among them.
Operations residual_operations(const Discretization& discretization, const Communicator& comm,
                               const FlowField<Real>& flow, const Conditions<Real>& conditions);

}  // namespace alphadot
