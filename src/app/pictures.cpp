#include "app/pictures.hpp"

#include "derivatives/loads.hpp"
#include "derivatives/part.hpp"
#include "io/vtkhdf.hpp"

namespace alphadot {

namespace {

void write_flow_picture(const std::string& path, const Setup& setup, const FlowField<Real>& flow,
                        const Origin& origin, const Communicator& comm) {
  const auto cells = static_cast<std::size_t>(setup.domain.owned_cells);
  const auto& stream = setup.settings.freestream;
  std::vector<Real> density(cells), pressure(cells), mach(cells), cp(cells), rank(cells, comm.rank());
  std::vector<Vec3> speed(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const auto& w = flow[static_cast<Index>(i)];
    density[i] = w[0];
    pressure[i] = w[4];
    speed[i] = velocity(w);
    mach[i] = mach_number(w, stream.gamma);
    cp[i] = pressure_coefficient(w[4], setup.settings);
  }
  write_flow(path, setup.domain,
             {{"density", density},
              {"pressure", pressure},
              {"mach", mach},
              {"cp", cp},
              {"velocity", speed},
              {"rank", rank}},
             origin, comm);
}

/// Boundary patches of the body, or of planes of symmetry.
std::vector<std::size_t> patches_of(const Setup& setup, bool of_body) {
  std::vector<std::string> names;
  for (const auto& [patch, kind] : setup.settings.boundary)
    if (of_body ? kind != BoundaryKind::farfield && kind != BoundaryKind::symmetry
                : kind == BoundaryKind::symmetry)
      names.push_back(patch);
  return numbers_of_patches(names, setup.domain.patch_names);
}

void write_surface_pictures(const std::string& folder, const Setup& setup, const ImplicitIteration& iteration,
                            const FieldsOnFaces& more, const Origin& origin, const Communicator& comm) {
  const auto pressure = iteration.residual().boundary_pressures();
  std::vector<Real> cp;
  for (const Real p : pressure) cp.push_back(pressure_coefficient(p, setup.settings));
  std::vector<VtkField> fields{{"pressure", {pressure.begin(), pressure.end()}}, {"cp", cp}};
  if (const auto planes = patches_of(setup, false); !planes.empty())
    write_surface(folder + "/symmetry.vtkhdf", setup.domain, fields, origin, comm, planes);
  for (const auto& [name, values] : more) fields.emplace_back(name, values);
  if (const auto body = patches_of(setup, true); !body.empty())
    write_surface(folder + "/surface.vtkhdf", setup.domain, fields, origin, comm, body);
}

}  // namespace

void write_pictures(const std::string& folder, const Setup& setup, const ImplicitIteration& iteration,
                    const FieldsOnFaces& more, const Origin& origin, const Communicator& comm) {
  if (setup.settings.output.flow)
    write_flow_picture(folder + "/flow.vtkhdf", setup, iteration.flow(), origin, comm);
  if (setup.settings.output.surface) write_surface_pictures(folder, setup, iteration, more, origin, comm);
}

}  // namespace alphadot
