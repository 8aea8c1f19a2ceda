// CGNS files written through the CGNS library, for tests.
#pragma once

#include <cgnslib.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "partition/mesh.hpp"

namespace alphadot::test {

inline void check(int status) {
  if (status != CG_OK) throw std::runtime_error(cg_get_error());
}

/// A file with one base and, at first, no zone. Sections and conditions go into the newest zone.
class CgnsFile {
 public:
  explicit CgnsFile(const std::string& path) {
    check(cg_set_file_type(CG_FILE_HDF5));
    check(cg_open(path.c_str(), CG_MODE_WRITE, &file_));
    check(cg_base_write(file_, "Base", 3, 3, &base_));
  }
  ~CgnsFile() { cg_close(file_); }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  int id() const { return file_; }
  int base() const { return base_; }
  int zone() const { return zone_; }
  /// The number of the next element.
  cgsize_t next() const { return next_; }

  /// `Number` is what the file keeps of a coordinate: double or float.
  template <class Number = double>
  void add_zone(const Mesh& mesh, const std::string& name = "Zone", const std::string& axis = "Coordinate") {
    cgsize_t size[3] = {static_cast<cgsize_t>(mesh.points.size()), static_cast<cgsize_t>(mesh.cells.size()),
                        0};
    check(cg_zone_write(file_, base_, name.c_str(), size, CGNS_ENUMV(Unstructured), &zone_));
    next_ = 1;
    for (int d = 0; d < 3; ++d) {
      std::vector<Number> values;
      for (const auto& point : mesh.points) values.push_back(static_cast<Number>(point[d]));
      int coordinate = 0;
      const std::string full = axis + "XYZ"[d];
      const auto type = sizeof(Number) == 4 ? CGNS_ENUMV(RealSingle) : CGNS_ENUMV(RealDouble);
      check(cg_coord_write(file_, base_, zone_, type, full.c_str(), values.data(), &coordinate));
    }
  }

  /// `elements` are arrays of point ids from 0. Returns the number of the first.
  template <class Elements>
  cgsize_t add_section(const std::string& name, CGNS_ENUMT(ElementType_t) type, const Elements& elements) {
    std::vector<cgsize_t> nodes;
    for (const auto& element : elements)
      for (const auto point : element) nodes.push_back(static_cast<cgsize_t>(point) + 1);
    const auto first = next_;
    next_ += static_cast<cgsize_t>(elements.size());
    int section = 0;
    check(cg_section_write(file_, base_, zone_, name.c_str(), type, first, next_ - 1, 0, nodes.data(),
                           &section));
    return first;
  }

  void add_mixed_section(const std::string& name, const std::vector<std::vector<cgsize_t>>& typed_elements) {
    std::vector<cgsize_t> entries, offsets{0};
    for (const auto& element : typed_elements) {
      entries.insert(entries.end(), element.begin(), element.end());
      offsets.push_back(static_cast<cgsize_t>(entries.size()));
    }
    const auto first = next_;
    next_ += static_cast<cgsize_t>(typed_elements.size());
    int section = 0;
    check(cg_poly_section_write(file_, base_, zone_, name.c_str(), CGNS_ENUMV(MIXED), first, next_ - 1, 0,
                                entries.data(), offsets.data(), &section));
  }

  /// A condition on faces, or on vertices; with a family unless that is empty.
  void add_condition(const std::string& name, CGNS_ENUMT(PointSetType_t) set,
                     const std::vector<cgsize_t>& ids, const std::string& family = "",
                     CGNS_ENUMT(GridLocation_t) location = CGNS_ENUMV(FaceCenter)) {
    int condition = 0;
    check(cg_boco_write(file_, base_, zone_, name.c_str(), CGNS_ENUMV(FamilySpecified), set,
                        static_cast<cgsize_t>(ids.size()), ids.data(), &condition));
    check(cg_boco_gridlocation_write(file_, base_, zone_, condition, location));
    if (family.empty()) return;
    check(cg_goto(file_, base_, "Zone_t", zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
    check(cg_famname_write(family.c_str()));
  }

 private:
  int file_ = 0, base_ = 0, zone_ = 0;
  cgsize_t next_ = 1;
};

}  // namespace alphadot::test
