#include "io/result.hpp"

#include <nlohmann/json.hpp>

#include "io/files.hpp"

namespace alphadot {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const NamedValues& values) {
  Json out = Json::object();
  for (const auto& [name, value] : values) out[name] = value;
  return out;
}

/// Single numbers stand for themselves, others in an array.
Json json_of(const ConfigurationResult& configuration) {
  Json out = Json::object();
  for (const auto& [name, values] : configuration.facts)
    out[name] = values.size() == 1 ? Json(values.front()) : Json(values);
  out["warnings"] = configuration.warnings;
  return out;
}

Json json_of(const Result& r) {
  Json forces = json_of(r.forces);
  forces["components"] = Json::object();
  for (const auto& [name, loads] : r.components) forces["components"][name] = json_of(loads);
  if (!r.one_side.empty()) forces["one_side"] = Json::object();
  for (const auto& [name, loads] : r.one_side) forces["one_side"][name] = json_of(loads);
  if (!r.panels.empty()) forces["panels"] = Json::object();
  for (const auto& [name, loads] : r.panels) forces["panels"][name] = json_of(loads);
  forces["excluded"] = r.excluded;
  Json estimates = Json::object();
  for (const auto& [name, estimate] : r.estimates)
    estimates[name] = {{"CA", estimate.CA}, {"source", estimate.source}};

  Json derivatives = Json::object();
  for (const auto& [name, d] : r.derivatives) {
    derivatives[name] = {
        {"value", d.value}, {"uncertainty", d.uncertainty}, {"method", d.method}, {"converged", d.converged}};
    if (!d.parts.empty()) derivatives[name]["parts"] = json_of(d.parts);
    if (!d.mesh_convergence.empty()) derivatives[name]["mesh_convergence"] = json_of(d.mesh_convergence);
  }

  const Vec3& center = r.reference.moment_center;
  const auto& performance = r.performance;
  const auto& source = r.provenance;
  Json out = {
      {"status", to_string(r.status)},
      {"message", r.message},
      {"not_reached", r.not_reached},
      {"title", r.title},
      {"verb", r.verb},
      {"ranks", source.ranks},
      {"mesh",
       {{"file", r.mesh.file}, {"cells", r.mesh.cells}, {"points", r.mesh.points}, {"hash", r.mesh.hash}}},
      {"configuration", json_of(r.configuration)},
      {"reference",
       {{"length", r.reference.length},
        {"area", r.reference.area},
        {"moment_center", Json::array({center.x, center.y, center.z})},
        {"model", r.reference.half_model ? "half" : "full"},
        {"rate", r.rate},
        {"axes", r.axes}}},
      {"freestream",
       {{"mach", r.freestream.mach},
        {"alpha", r.freestream.alpha},
        {"beta", r.freestream.beta},
        {"gamma", r.freestream.gamma}}},
      {"forces", forces},
      {"estimates", estimates},
      {"derivatives", derivatives},
      {"uncertainty", r.uncertainty},
      {"longitudinal", json_of(r.longitudinal)},
      {"performance",
       {{"wall_s", performance.wall_s},
        {"cpu_s", performance.cpu_s},
        {"steady_wall_s", performance.steady_wall_s},
        {"steady_cpu_s", performance.steady_cpu_s},
        {"motion_cpu_s", performance.motion_cpu_s},
        {"linear_cpu_s", performance.linear_cpu_s},
        {"coarser_meshes_cpu_s", performance.coarser_meshes_cpu_s},
        {"checkpoints", performance.checkpoints},
        {"checkpoint_wall_s", performance.checkpoint_wall_s},
        {"checkpoint_cpu_s", performance.checkpoint_cpu_s},
        {"restart_wall_s", performance.restart_wall_s},
        {"restart_cpu_s", performance.restart_cpu_s},
        {"iterations", performance.iterations},
        {"core_us_per_cell_iteration", performance.core_us_per_cell_iteration},
        {"bytes_per_cell", performance.bytes_per_cell},
        {"mesh_bytes_per_cell", performance.mesh_bytes_per_cell},
        {"reading_bytes_per_cell", performance.reading_bytes_per_cell},
        {"peak_bytes_per_cell", performance.peak_bytes_per_cell},
        {"busiest_rank_bytes", performance.busiest_rank_bytes},
        {"halo_fraction", performance.halo_fraction},
        {"halo_bytes_per_iteration", performance.halo_bytes_per_iteration},
        {"most_messages_per_iteration", performance.most_messages_per_iteration},
        {"ghost_fraction", performance.ghost_fraction},
        {"load_imbalance", performance.load_imbalance}}},
      {"provenance",
       {{"version", source.version},
        {"commit", source.commit},
        {"compiler", source.compiler},
        {"flags", source.flags},
        {"build_type", source.build_type},
        {"mpi", source.mpi_version},
        {"hdf5", source.hdf5_version},
        {"cpu", source.cpu},
        {"host", source.host},
        {"date", source.date}}},
      {"motion_table_hash", r.motion_table_hash},
      {"case", r.case_text}};
  if (!r.decay.empty()) out["decay"] = json_of(r.decay);
  return out;
}

}  // namespace

std::string result_json(const Result& result) {
  // The library writes null for what is not finite, and the replacement character for what is not UTF-8.
  return json_of(result).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_result(const std::string& path, const Result& result) {
  replace_file_with(path, result_json(result));
}

}  // namespace alphadot
