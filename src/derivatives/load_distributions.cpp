#include "derivatives/load_distributions.hpp"

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>

#include "analysis/panel.hpp"
#include "derivatives/controls.hpp"
#include "derivatives/flight_variables.hpp"
#include "derivatives/loads.hpp"

namespace alphadot {

namespace {

/// to += weight from
void add(std::vector<Load>& to, Real weight, std::span<const Load> from) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to[i] += weight * from[i];
}

}  // namespace

LoadDistributions::LoadDistributions(FlowCase& flow, SensitivitySolver& solver, const Responses& responses)
    : flow_(flow),
      steady_(face_loads(flow.discretization(),
                         excess_pressures(flow.discretization(), flow.iteration().residual()),
                         flow.iteration().moment_center())) {
  for (const auto& group : groups_of(flow.settings())) {
    std::vector<ResponseProblem> asked;
    std::vector<SensitivityProblem> problems;
    std::vector<std::span<const Primitive<Real>>> solutions;
    for (const Variable variable : group) {
      asked.push_back(problem_of({variable}, flow, responses));
      solutions.emplace_back(responses.at({variable}).field);
    }
    problems.reserve(asked.size());
    for (const auto& one : asked) problems.push_back(one.problem);
    const auto found = solver.face_loads(problems, solutions);
    for (std::size_t i = 0; i < group.size(); ++i) {
      const Real scale = rate_scale(group[i], flow.settings());
      add(by_[group[i]], scale, found[i]);
      if (asked[i].held) add(by_[group[i]], scale, asked[i].held->of_faces);
    }
  }
  for (const auto& sets : {control_sets_of(flow.settings()), control_set_rates_of(flow.settings())})
    for (const Variable set : sets)
      for (const auto& [term, weight] : terms_of(set, flow.settings())) add(by_[set], weight, by_.at(term));
}

std::vector<Distribution> LoadDistributions::along_body() const {
  const Case& settings = flow_.settings();
  const auto& domain = flow_.setup().domain;
  std::vector<Distribution> out;
  const auto distribute = [&](const std::string& of, const std::vector<std::string>& walls) {
    const Slices slices(domain, numbers_of_patches(walls, domain.patch_names), {}, {1, 0, 0},
                        settings.output.stations, flow_.communicator());
    auto& quantities = out.emplace_back(Distribution{of, slices.ends(), {}}).quantities;
    const auto add_all = [&](std::string_view by, std::span<const Load> faces) {
      const auto loads = slices.of(faces);
      for (int i = 0; i < Coefficients::size(); ++i) {
        auto& [name, values] = quantities.emplace_back(
            std::string(coefficient_names[static_cast<std::size_t>(i)]), std::vector<Real>{});
        if (!by.empty()) name.append("_").append(by);
        for (const auto& load : loads) values.push_back(coefficients(load, settings)[i]);
      }
    };
    add_all("", steady_);
    for (const auto& [variable, faces] : by_) add_all(name(variable), faces);
  };
  std::vector<std::string> walls;
  for (const auto& [patch, kind] : settings.boundary)
    if (kind == BoundaryKind::wall) walls.push_back(patch);
  distribute("total", walls);
  for (const auto& [name, of_set] : settings.components) distribute(name, of_set);
  return out;
}

std::vector<Distribution> LoadDistributions::along_panels() const {
  const FlightCondition settings = of_one_side(flow_.settings());
  const auto& domain = flow_.setup().domain;
  std::vector<Distribution> out;
  for (const auto& control : flow_.settings().controls) {
    const PanelFrame frame = frame_of(control);
    if (norm(frame.outboard) == 0) continue;
    const Slices slices(domain, numbers_of_patches(control.patches, domain.patch_names), frame.point,
                        frame.outboard, flow_.settings().output.stations, flow_.communicator());
    auto& quantities = out.emplace_back(Distribution{control.name, slices.ends(), {}}).quantities;
    const auto add_all = [&](std::string_view by, std::span<const Load> faces) {
      std::vector<std::pair<std::string, std::vector<Real>>> columns;
      columns.reserve(panel_load_names.size());
      for (const auto name : panel_load_names)
        columns.emplace_back(by.empty() ? std::string(name) : fmt::format("{}_{}", name, by),
                             std::vector<Real>{});
      for (const auto& load : slices.of(faces)) {
        const auto loads = panel_loads(coefficients(load, settings), frame, settings.reference);
        for (std::size_t i = 0; i < columns.size(); ++i) columns[i].second.push_back(loads[i]);
      }
      quantities.insert(quantities.end(), columns.begin(), columns.end());
    };
    add_all("", steady_);
    for (const auto& [variable, faces] : by_) add_all(name(variable), faces);
  }
  return out;
}

FieldsOnFaces LoadDistributions::pressures() const {
  const auto& domain = flow_.setup().domain;
  const Real mach = flow_.settings().freestream.mach, dynamic_pressure = 0.5 * mach * mach;
  FieldsOnFaces out;
  for (const auto& [variable, faces] : by_) {
    if (terms_of(variable, flow_.settings()).size() > 1 || is_control_rate(variable)) continue;
    auto& values = out.emplace_back(derivative_name("cp", variable), std::vector<Real>{}).second;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vec3& normal = domain.boundary_normal[i];
      values.push_back(dot(faces[i].force, normal) / (dynamic_pressure * dot(normal, normal)));
    }
  }
  return out;
}

}  // namespace alphadot
