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

/// By its place among the controls.
std::size_t number_of(Variable control, const Case& settings) {
  const auto& controls = settings.controls;
  return static_cast<std::size_t>(std::ranges::find(controls, name(control), &ControlSettings::name) -
                                  controls.begin());
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

namespace {

HeldFlowChange change_by_turn(FlowCase& flow, const ControlSettings& turning, bool is_rate) {
  const auto patches = turning_patches(turning, flow.settings().mesh);
  return change_by_turn(flow.iteration(), flow.conditions(), [&](Real by) {
    return turned_further(flow.discretization(), patches, hinge_of(turning), is_rate ? 0 : by,
                          is_rate ? by : 0);
  });
}

}  // namespace

HeldFlowChange change_by_control(FlowCase& flow, Variable control, bool limiter_held) {
  const Case& settings = flow.settings();
  const bool is_rate = is_control_rate(control);
  const std::size_t number = number_of(is_rate ? control_of_rate(control) : control, settings);
  if (settings.space.deflection == DeflectionKind::transpiration)
    return change_by_turn(flow, settings.controls[number], is_rate);
  const auto& displacement = flow.control_deflections()[number].displacement;
  return is_rate ? change_by_velocity(flow.iteration(), flow.conditions(), displacement)
                 : change_by_displacement(flow.iteration(), flow.conditions(), displacement, limiter_held);
}

}  // namespace alphadot
