#include "derivatives/controls.hpp"

#include <algorithm>

#include "march/turning.hpp"

namespace alphadot {

namespace {

std::vector<Variable> rates_of(std::vector<Variable> controls, const Case& settings) {
  if (!settings.derivatives.control_rates) return {};
  for (auto& control : controls) control = rate_of_control(control);
  return controls;
}

const ControlSettings& settings_of(const FlowCase& flow, Variable control) {
  return *std::ranges::find(flow.settings().controls, name(control), &ControlSettings::name);
}

}  // namespace

std::vector<Variable> controls_of(const Case& settings) {
  std::vector<Variable> out;
  for (const auto& control : settings.controls) out.push_back(control_variable(control.name));
  return out;
}

std::vector<Variable> control_sets_of(const Case& settings) {
  std::vector<Variable> out;
  for (const auto& [name, weights] : settings.control_sets) out.push_back(control_variable(name));
  return out;
}

std::vector<Variable> control_rates_of(const Case& settings) {
  return rates_of(controls_of(settings), settings);
}

std::vector<Variable> control_set_rates_of(const Case& settings) {
  return rates_of(control_sets_of(settings), settings);
}

Terms terms_of(Variable variable, const Case& settings) {
  const bool is_rate = is_control_rate(variable);
  const auto deflected = is_rate ? control_of_rate(variable) : variable;
  const auto set = settings.control_sets.find(std::string(name(deflected)));
  if (!is_control(variable) || set == settings.control_sets.end()) return {{variable, 1}};
  Terms out;
  for (const auto& [name, weight] : set->second) {
    const auto control = control_variable(name);
    out.emplace_back(is_rate ? rate_of_control(control) : control, weight);
  }
  return out;
}

Deflection deflection_of(const FlowCase& flow, Variable control) {
  const auto& found = settings_of(flow, control);
  return deflection(flow.discretization(), turning_patches(found, flow.settings().mesh), hinge_of(found),
                    flow.communicator());
}

namespace {

HeldFlowChange change_by_turn(FlowCase& flow, Variable control) {
  const bool is_rate = is_control_rate(control);
  const auto& turning = settings_of(flow, is_rate ? control_of_rate(control) : control);
  const auto patches = turning_patches(turning, flow.settings().mesh);
  return change_by_turn(flow.iteration(), flow.conditions(), [&](Real by) {
    return turned_further(flow.discretization(), patches, hinge_of(turning), is_rate ? 0 : by,
                          is_rate ? by : 0);
  });
}

}  // namespace

HeldFlowChange change_by_control(FlowCase& flow, Variable control, bool limiter_held) {
  if (flow.settings().space.deflection == DeflectionKind::transpiration) return change_by_turn(flow, control);
  if (is_control_rate(control))
    return change_by_velocity(flow.iteration(), flow.conditions(),
                              deflection_of(flow, control_of_rate(control)).displacement);
  return change_by_displacement(flow.iteration(), flow.conditions(),
                                deflection_of(flow, control).displacement, limiter_held);
}

}  // namespace alphadot
