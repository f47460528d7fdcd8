#pragma once
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "thixis/output/fields.hpp"

namespace thixis::output {

struct Array {
  std::vector<long long> shape;
  std::vector<double> values;
};

/// An array of an HDF5 file as one process reads it; empty if it is not there.
inline Array read_array(const std::string& path, const std::string& name) {
  Array result;
  H5E_auto2_t print;
  void* data;
  H5Eget_auto2(H5E_DEFAULT, &print, &data);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t array = file < 0 ? -1 : H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (array >= 0) {
    const hid_t space = H5Dget_space(array);
    std::vector<hsize_t> shape(H5Sget_simple_extent_ndims(space));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    result.shape.assign(shape.begin(), shape.end());
    result.values.resize(H5Sget_simple_extent_npoints(space));
    H5Dread(array, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data());
    H5Sclose(space);
    H5Dclose(array);
  }
  if (file >= 0) H5Fclose(file);
  H5Eset_auto2(H5E_DEFAULT, print, data);
  return result;
}

/// The XDMF file of a folder, every array of which must be there with the dimensions it says.
inline pugi::xml_document read_xdmf(const std::string& folder) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file((folder + "/fields.xdmf").c_str()));
  for (const auto& found : document.select_nodes("//DataItem")) {
    const std::string address = found.node().text().as_string();
    const std::size_t colon = address.find(':');
    std::istringstream dimensions(found.node().attribute("Dimensions").as_string());
    std::vector<long long> shape;
    for (long long length; dimensions >> length;) shape.push_back(length);
    EXPECT_EQ(read_array(folder + "/" + address.substr(0, colon), address.substr(colon + 1)).shape, shape) << address;
  }
  return document;
}

/// A strip of 2 n triangles between the lines y = 0 and y = 1. All ranks hold everything, each in another order; owners and numbers are
/// scattered: point k of the strip has the number (17 k + 3) mod 2(n + 1), triangle k the number (19 k + 5) mod 2 n.
struct Strip {
  int n;
  int points() const { return 2 * (n + 1); }
  int triangles() const { return 2 * n; }
  long long point_number(int k) const { return (17 * k + 3) % points(); }
  long long triangle_number(int k) const { return (19 * k + 5) % triangles(); }
  std::array<double, 2> point(int k) const { return {(k / 2) / 3.0, static_cast<double>(k % 2)}; }
  std::array<int, 3> triangle(int k) const { return k % 2 == 0 ? std::array{k, k + 2, k + 1} : std::array{k, k + 1, k + 2}; }

  Grid grid(const core::Comm& comm) const {
    Grid result;
    result.global_points = points();
    result.global_triangles = triangles();
    const int shift = comm.rank();
    for (int i = 0; i < points(); ++i) {
      const int k = (i + shift) % points();
      result.points.push_back(point(k));
      result.point_id.push_back(point_number(k));
      result.point_owner.push_back((k * k) % comm.size());
    }
    for (int i = 0; i < triangles(); ++i) {
      const int k = (i + shift) % triangles();
      const auto corners = triangle(k);
      std::array<LocalIndex, 3> local{};
      for (int c = 0; c < 3; ++c) local[c] = (corners[c] - shift + points()) % points();
      result.triangles.push_back(local);
      result.triangle_id.push_back(triangle_number(k));
      result.triangle_owner.push_back((k / 2) % comm.size());
    }
    return result;
  }
};

/// A field with the value f(id) for owned entities and NaN for the others.
template <class F>
FieldData owned_field(const std::string& name, Centre centre, const Grid& grid, const core::Comm& comm, int components, F&& f) {
  const auto& id = centre == Centre::vertex ? grid.point_id : grid.triangle_id;
  const auto& owner = centre == Centre::vertex ? grid.point_owner : grid.triangle_owner;
  FieldData field{name, centre, {}, components};
  for (std::size_t i = 0; i < id.size(); ++i)
    for (int c = 0; c < components; ++c) field.values.push_back(owner[i] == comm.rank() ? f(id[i], c) : NAN);
  return field;
}

}  // namespace thixis::output
