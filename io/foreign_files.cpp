#include "io/foreign_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace alphadot {
namespace {

struct Foreign {
  std::string_view beginning;
  const char* what;
  const char* remedy;
};

constexpr const char* fluent_remedy =
    "export the mesh from Fluent or its mesher as CGNS and convert it: alphadot-cgns2su2 FILE.cgns mesh.su2";
constexpr const char* openfoam_remedy =
    "write the mesh with the program that made it as Gmsh, SU2, UGRID or CGNS file; polyhedra cannot be used";

constexpr std::array<Foreign, 12> beginnings{
    {{"version https://git-lfs.github.com/spec/", "the file is a Git LFS pointer, not the mesh itself",
      "get the mesh with git lfs pull"},
     {"(", "the file is a mesh or case of Fluent, which is not read", fluent_remedy},
     {"FoamFile", "the file is of OpenFOAM, whose polyMesh is not read", openfoam_remedy},
     {"/*---", "the file is of OpenFOAM, whose polyMesh is not read", openfoam_remedy},
     {"<!DOCTYPE", "the file is a web page, not a mesh", "load the file itself"},
     {"<html", "the file is a web page, not a mesh", "load the file itself"},
     {"<?xml", "the file is of XML, not a mesh that can be read", "convert it with a mesh generator"},
     {"<VTKFile", "the file is of VTK, which is not read", "convert it with meshio to .su2 or .msh"},
     {"# vtk", "the file is of VTK, which is not read", "gmsh FILE.vtk -save -o mesh.msh converts it"},
     {"PK\x03\x04", "the file is a zip archive", "unzip it"},
     {"BZh", "the file is compressed by bzip2",
      "bunzip2 it; of compressed files only those of gzip are read"},
     {"\xfd"
      "7zXZ",
      "the file is compressed by xz", "unxz it; of compressed files only those of gzip are read"}}};

struct ForeignName {
  std::string_view extension;
  const char* what;
  const char* remedy;
};
constexpr const char* through_gmsh = "gmsh FILE -save -format msh41 -o mesh.msh converts it, groups included";
constexpr const char* surface_only = "mesh the volume around it first, with Gmsh for example";

constexpr std::array<ForeignName, 18> names{
    {{".cas", "cases of Fluent are not read", fluent_remedy},
     {".cas.h5", "cases of Fluent are not read", fluent_remedy},
     {".msh.h5", "meshes of Fluent are not read", fluent_remedy},
     {".foam", "OpenFOAM's polyMesh is not read", openfoam_remedy},
     {".unv", "I-deas files are not read", through_gmsh},
     {".med", "MED files are not read", through_gmsh},
     {".bdf", "Nastran files are not read", through_gmsh},
     {".nas", "Nastran files are not read", through_gmsh},
     {".mesh", "Medit files are not read", through_gmsh},
     {".vtk", "VTK files are not read", through_gmsh},
     {".vtu", "VTK files are not read", "convert it with meshio to .su2 or .msh"},
     {".stl", "the file is a surface without a volume", surface_only},
     {".tri", "the file is a surface without a volume", surface_only},
     {".obj", "the file is a surface without a volume", surface_only},
     {".step", "the file is a geometry without a mesh", surface_only},
     {".stp", "the file is a geometry without a mesh", surface_only},
     {".iges", "the file is a geometry without a mesh", surface_only},
     {".geo", "the file is Gmsh's description of a geometry, not a mesh", "gmsh -3 FILE.geo -o mesh.msh"}}};

}  // namespace

std::optional<Problem> foreign_content(const std::string& path, std::string_view content) {
  for (const auto& [beginning, what, remedy] : beginnings)
    if (content.starts_with(beginning)) return Problem{path, 0, what, remedy};
  return std::nullopt;
}

std::optional<Problem> foreign_name(const std::string& path, std::string_view name) {
  for (const auto& [extension, what, remedy] : names)
    if (name.ends_with(extension)) return Problem{path, 0, what, remedy};
  return std::nullopt;
}

std::optional<Problem> foreign_folder(const std::string& path) {
  std::error_code error;
  const std::filesystem::path folder(path);
  for (const char* inside : {"", "polyMesh", "constant/polyMesh"})
    if (std::filesystem::exists(folder / inside / "owner", error) ||
        std::filesystem::exists(folder / inside / "owner.gz", error))
      return Problem{path, 0, "the folder is a mesh of OpenFOAM, whose polyMesh is not read",
                     openfoam_remedy};
  return std::nullopt;
}

}  // namespace alphadot
