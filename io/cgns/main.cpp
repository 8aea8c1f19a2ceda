// alphadot-cgns2su2: makes an SU2 mesh, which alphadot reads, from a CGNS file. A program of its own because
// the CGNS library is built on serial HDF5 and must not meet the parallel one of the solver.
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include "core/error.hpp"
#include "io/cgns/cgns_reader.hpp"
#include "io/cgns/su2_writer.hpp"

namespace {

using namespace alphadot;

int convert(const std::string& from, const std::string& to) {
  try {
    std::error_code error;
    if (std::filesystem::equivalent(from, to, error))
      throw InputError(to, 0, "the SU2 file would replace the CGNS file itself", "name another file");
    const MeshOfFile mesh = read_cgns(from, [](const std::string& note) { fmt::print("{}\n", note); });
    for (const auto& note : mesh.notes) fmt::print("{}\n", note);
    write_su2(to, mesh);
    fmt::print("{}: {} tetrahedra, {} points\n", to, mesh.cells.size(), mesh.points.size());
    for (const auto& patch : mesh.patches)
      fmt::print("  {}: {} triangles\n", patch.name, patch.triangles.size());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "alphadot-cgns2su2: error: {}\n", error.what());
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk, not the end
  CLI::App app{
      "Makes an SU2 mesh of tetrahedra from the unstructured mesh in a CGNS file.\n"
      "Exit codes: 0 converted, 1 error, 2 wrong command line."};
  std::string from, to;
  app.add_option("from", from, "CGNS file")->required();
  app.add_option("to", to, "SU2 file")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return convert(from, to);
}
