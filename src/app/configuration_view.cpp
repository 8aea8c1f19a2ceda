#include "app/configuration_view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace alphadot {

namespace {

/// Small numbers that are round-off are shown as zero.
Real shown(Real value) {
  return std::abs(value) < 1e-12 ? 0 : value;
}
std::string text(const Vec3& v) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", shown(v.x), shown(v.y), shown(v.z));
}
std::vector<Real> numbers(const Vec3& v) {
  return {v.x, v.y, v.z};
}

std::string far_field_text(const Configuration& facts, Real mach) {
  const auto distance = fmt::format("far field: at least {:.4g} body lengths away",
                                    facts.far_field_distance / facts.body_length);
  if (mach <= 1)
    return fmt::format("{}; Mach {:g} needs {:.3g}", distance, mach,
                       needed_far_field_distance(mach, facts.is_section));
  if (std::isinf(facts.far_field_ratio)) return distance + "; no Mach wave comes back from it";
  return fmt::format("{}; no Mach wave comes back from it before {:.3g} body lengths behind the nose",
                     distance, facts.far_field_ratio);
}

std::string symmetry_text(const Setup& setup) {
  std::vector<std::string> planes;
  for (const auto& plane : setup.configuration.planes)
    planes.push_back(fmt::format(
        "{} across {}", setup.domain.patch_names[static_cast<std::size_t>(plane.patch)], text(plane.normal)));
  return planes.empty() ? "none" : fmt::format("{}", fmt::join(planes, ", "));
}

}  // namespace

std::string configuration_text(const Setup& setup) {
  const Configuration& facts = setup.configuration;
  const auto cell_text = [&](const WorstCell& cell) {
    return fmt::format("cell {} at {}", cell.id + 1, text((1 / setup.settings.mesh.scale) * cell.at));
  };
  std::string out = fmt::format("domain: from {} to {} reference lengths; symmetry planes: {}\n",
                                text(facts.domain.lower), text(facts.domain.upper), symmetry_text(setup));
  if (facts.has_body)
    out += fmt::format(
        "body: from {} to {}, {:.5g} reference lengths long\n"
        "walls: {:.5g} reference areas; seen along x, y and z {}; out of balance by {}\n{}\n"
        "mirror image in z: surface {:.2g}, its triangles {:.2g}, cells {:.2g} apart (0: the same, 1: "
        "one-sided)\n",
        text(facts.body.lower), text(facts.body.upper), facts.body_length, facts.wall_area,
        text(facts.projected_area), text(facts.net_area),
        far_field_text(facts, setup.settings.freestream.mach), facts.surface_asymmetry,
        facts.triangle_asymmetry, facts.cell_asymmetry);
  const auto& [angle, aspect, ratio] = facts.quality;
  out += fmt::format(
      "worst cells: {:.3g} degrees between two faces ({}), aspect ratio {:.3g} ({}), a neighbour {:.3g} "
      "times as "
      "large ({})\n",
      angle.value, cell_text(angle), aspect.value, cell_text(aspect), ratio.value, cell_text(ratio));
  return out;
}

ConfigurationResult configuration_result(const Setup& setup) {
  const Configuration& facts = setup.configuration;
  ConfigurationResult out;
  out.facts = {{"regions", {static_cast<Real>(facts.region_count)}},
               {"domain_lower", numbers(facts.domain.lower)},
               {"domain_upper", numbers(facts.domain.upper)}};
  const auto add = [&](std::string name, std::vector<Real> values) {
    out.facts.emplace_back(std::move(name), std::move(values));
  };
  if (facts.has_body) {
    add("body_lower", numbers(facts.body.lower));
    add("body_upper", numbers(facts.body.upper));
    add("body_length", {facts.body_length});
    add("wall_area", {facts.wall_area});
    add("projected_area", numbers(facts.projected_area));
    add("net_area", numbers(facts.net_area));
    add("surface_asymmetry", {facts.surface_asymmetry});
    add("triangle_asymmetry", {facts.triangle_asymmetry});
    add("cell_asymmetry", {facts.cell_asymmetry});
    add("far_field_distance", {facts.far_field_distance});
    add("far_field_ratio", {facts.far_field_ratio});
  }
  const auto& quality = facts.quality;
  const auto add_cell = [&](const std::string& name, const WorstCell& cell) {
    add(name, {cell.value});
    add(name + "_at", numbers((1 / setup.settings.mesh.scale) * cell.at));
  };
  add_cell("smallest_angle", quality.smallest_angle);
  add_cell("aspect_ratio", quality.aspect_ratio);
  add_cell("volume_ratio", quality.volume_ratio);
  out.warnings = setup.warnings;
  return out;
}

}  // namespace alphadot
