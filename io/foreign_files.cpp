#include "io/foreign_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace alphadot {
namespace {

constexpr std::size_t beginning_bytes = 64;  ///< of a file, which tell what it is

struct Foreign {
  std::string_view beginning;
  const char* what;
  const char* remedy;
};

constexpr const char* fluent_remedy =
    "export the mesh from Fluent or its mesher as CGNS and convert it: alphadot-cgns2su2 FILE.cgns mesh.su2";
constexpr const char* openfoam_remedy =
    "write the mesh with the program that made it as Gmsh, SU2, UGRID or CGNS file; polyhedra cannot be used";
constexpr const char* with_groups = "gmsh FILE -save -format msh41 -o mesh.msh converts it, groups included";
constexpr const char* through_gmsh =
    "gmsh FILE -save -format msh41 -o mesh.msh converts it; groups lose their names: "
    "patches become surface_1, surface_2 ...";
constexpr const char* surface_only = "mesh the volume around it first, with Gmsh for example";
constexpr const char* from_its_program =
    "write the mesh with the program that made it as Gmsh, SU2, UGRID or CGNS file";

/// In lower case, as what they are compared with.
constexpr std::array<Foreign, 22> beginnings{
    {{"\xff\xfe", "the file is text in UTF-16", "save it as ASCII or UTF-8"},
     {"\xfe\xff", "the file is text in UTF-16", "save it as ASCII or UTF-8"},
     {"version https://git-lfs.github.com/spec/", "the file is a Git LFS pointer, not the mesh itself",
      "get the mesh with git lfs pull"},
     {"(0", "the file is a mesh or case of Fluent, which is not read", fluent_remedy},
     {"(1", "the file is a mesh or case of Fluent, which is not read", fluent_remedy},
     {"(2", "the file is a mesh or case of Fluent, which is not read", fluent_remedy},
     {"(4", "the file is a mesh or case of Fluent, which is not read", fluent_remedy},
     {"foamfile", "the file is of OpenFOAM, whose polyMesh is not read", openfoam_remedy},
     {"/*---", "the file is of OpenFOAM, whose polyMesh is not read", openfoam_remedy},
     {"<!doctype", "the file is a web page, not a mesh", "load the file itself"},
     {"<html", "the file is a web page, not a mesh", "load the file itself"},
     {"<?xml", "the file is of XML, not a mesh that can be read", "convert it with a mesh generator"},
     {"<vtkfile", "the file is of VTK, which is not read", from_its_program},
     {"# vtk", "the file is of VTK, which is not read", from_its_program},
     {"solid ", "the file is STL, a surface without a volume", surface_only},
     {"ply\n", "the file is PLY, a surface without a volume", surface_only},
     {"ply\r", "the file is PLY, a surface without a volume", surface_only},
     {"begin bulk", "the file is of Nastran, which is not read", through_gmsh},
     {"$ ", "the file begins with a comment of Nastran, which is not read", through_gmsh},
     {"pk\x03\x04", "the file is a zip archive", "unzip it"},
     {"bzh", "the file is compressed by bzip2",
      "bunzip2 it; of compressed files only those of gzip are read"},
     {"\xfd"
      "7zxz",
      "the file is compressed by xz", "unxz it; of compressed files only those of gzip are read"}}};

struct ForeignName {
  std::string_view extension;
  const char* what;
  const char* remedy;
};
constexpr const char* unpack = "unpack it; of compressed files only those of gzip are read";

constexpr std::array<ForeignName, 47> names{
    {{".cgns", "CGNS files are not read directly", "convert it: alphadot-cgns2su2 FILE.cgns mesh.su2"},
     {".cas", "cases of Fluent are not read", fluent_remedy},
     {".cas.h5", "cases of Fluent are not read", fluent_remedy},
     {".msh.h5", "meshes of Fluent are not read", fluent_remedy},
     {".foam", "OpenFOAM's polyMesh is not read", openfoam_remedy},
     {".unv", "I-deas files are not read", with_groups},
     {".med", "MED files are not read", from_its_program},
     {".bdf", "Nastran files are not read", through_gmsh},
     {".nas", "Nastran files are not read", through_gmsh},
     {".mesh", "Medit files are not read", through_gmsh},
     {".meshb", "Medit files are not read", through_gmsh},
     {".vtk", "VTK files are not read", from_its_program},
     {".vtu", "VTK files are not read", from_its_program},
     {".p3d", "Plot3D files are not read", from_its_program},
     {".xyz", "Plot3D files are not read", from_its_program},
     {".neu", "Gambit's neutral files are not read", from_its_program},
     {".inp", "Abaqus files are not read", from_its_program},
     {".exo", "Exodus files are not read", from_its_program},
     {".ccm", "files of STAR-CCM+ are not read", from_its_program},
     {".cogsg", "files of VGRID are not read", from_its_program},
     {".fgrid", "FAST files are not read", from_its_program},
     {".plt", "Tecplot files are not read", from_its_program},
     {".xdmf", "XDMF files are not read", from_its_program},
     {".b8l.ugrid", "UGRID files with integers of 64 bits are not read", from_its_program},
     {".lb8l.ugrid", "UGRID files with integers of 64 bits are not read", from_its_program},
     {".ugrid64", "UGRID files with integers of 64 bits are not read", from_its_program},
     {".stl", "the file is a surface without a volume", surface_only},
     {".tri", "the file is a surface without a volume", surface_only},
     {".obj", "the file is a surface without a volume", surface_only},
     {".ply", "the file is a surface without a volume", surface_only},
     {".off", "the file is a surface without a volume", surface_only},
     {".step", "the file is a geometry without a mesh", surface_only},
     {".stp", "the file is a geometry without a mesh", surface_only},
     {".iges", "the file is a geometry without a mesh", surface_only},
     {".igs", "the file is a geometry without a mesh", surface_only},
     {".brep", "the file is a geometry without a mesh", surface_only},
     {".geo", "the file is Gmsh's description of a geometry, not a mesh", "gmsh -3 FILE.geo -o mesh.msh"},
     {".geo_unrolled", "the file is Gmsh's description of a geometry, not a mesh",
      "gmsh -3 FILE.geo_unrolled -o mesh.msh"},
     {".zip", "the file is an archive", unpack},
     {".7z", "the file is an archive", unpack},
     {".tar", "the file is an archive", unpack},
     {".tgz", "the file is an archive", unpack},
     {".bz2", "the file is compressed by bzip2", unpack},
     {".xz", "the file is compressed by xz", unpack},
     {".zst", "the file is compressed by zstd", unpack},
     {".toml", "the file is a case or a description, not a mesh", "name the mesh"},
     {".vtkhdf", "the file is a picture of a flow or a checkpoint, not a mesh", "name the mesh"}}};

}  // namespace

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

std::optional<Problem> foreign_content(const std::string& path, std::string_view content, Expected expected) {
  constexpr std::size_t least_of_binary = 8;
  if (expected == Expected::text) {
    if (content.starts_with("\xef\xbb\xbf")) content.remove_prefix(3);
    content.remove_prefix(std::min(content.find_first_not_of(" \t\r\n"), content.size()));
  }
  const std::string start = in_lower_case(content.substr(0, beginning_bytes));
  for (const auto& [beginning, what, remedy] : beginnings)
    if (start.starts_with(beginning) && (expected == Expected::text || beginning.size() >= least_of_binary))
      return Problem{path, 0, what, remedy};
  return std::nullopt;
}

std::optional<Problem> foreign_name(const std::string& path, std::string_view name) {
  for (const auto& [extension, what, remedy] : names)
    if (name.ends_with(extension)) return Problem{path, 0, what, remedy};
  return std::nullopt;
}

std::string beginning_of(const std::string& path) {
  std::string out(beginning_bytes, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(out.data(), static_cast<std::streamsize>(out.size()));
  out.resize(static_cast<std::size_t>(stream.gcount()));
  return out;
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
