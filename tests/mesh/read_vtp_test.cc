#include <algorithm>

#include <gtest/gtest.h>

#include <zlib.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;

std::string Base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (size_t k = i; k < i + 3; ++k) {
      bits = bits << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0);
    }
    for (int k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

/// How a file stores its arrays.
struct Variant {
  const char* format = "ascii";
  bool base64 = false;  // of appended data
  bool compressed = false, big_endian = false, wide_headers = false, wide_indices = false;

  std::string Text() const {
    return std::string(format) + (base64 ? " base64" : "") + (compressed ? " zlib" : "") +
           (big_endian ? " big-endian" : "") + (wide_headers ? " UInt64 headers" : "") +
           (wide_indices ? " Int64" : "");
  }
};

/// Writes .vtp files in all the ways in which VTK does.
class VtpWriter {
 public:
  explicit VtpWriter(const Variant& variant) : variant_(variant) {}

  template <typename Number>
  void Add(const std::string& type, const std::string& name, int components,
           const std::vector<Number>& numbers) {
    std::string inside;
    xml_ += "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" format=\"" + variant_.format + "\"";
    if (variant_.format == std::string("ascii")) {
      for (const Number number : numbers) inside += std::to_string(number) + '\n';
    } else {
      std::string bytes;
      for (const Number number : numbers) Append(number, &bytes);
      const std::string encoded = Encoded(bytes);
      if (variant_.format == std::string("binary")) {
        inside = "\n      " + encoded + "\n";
      } else {
        xml_ += " offset=\"" + std::to_string(appended_.size()) + "\"";
        appended_ += encoded;
      }
    }
    xml_ += ">" + inside + "</DataArray>\n";
  }

  void Xml(const std::string& text) { xml_ += text; }

  void Index(const std::string& name, const std::vector<int>& numbers) {
    if (variant_.wide_indices) {
      Add("Int64", name, 1, std::vector<std::int64_t>(numbers.begin(), numbers.end()));
    } else {
      Add("Int32", name, 1, numbers);
    }
  }

  std::string Content() const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\"";
    text += variant_.big_endian ? " byte_order=\"BigEndian\"" : " byte_order=\"LittleEndian\"";
    if (variant_.wide_headers) text += " header_type=\"UInt64\"";
    if (variant_.compressed) text += " compressor=\"vtkZLibDataCompressor\"";
    text += ">\n<PolyData>\n" + xml_ + "</PolyData>\n";
    if (!appended_.empty()) {
      text += "<AppendedData encoding=\"" + std::string(variant_.base64 ? "base64" : "raw") +
              "\">\n _" + appended_ + "\n</AppendedData>\n";
    }
    return text + "</VTKFile>\n";
  }

 private:
  template <typename Number>
  void Append(Number number, std::string* bytes) const {
    variant_.big_endian ? internal::AppendBigEndian(number, bytes)
                        : internal::AppendLittleEndian(number, bytes);
  }

  std::string Header(const std::vector<size_t>& numbers) const {
    std::string bytes;
    for (const size_t number : numbers) {
      if (variant_.wide_headers) {
        Append(std::uint64_t{number}, &bytes);
      } else {
        Append(static_cast<std::uint32_t>(number), &bytes);
      }
    }
    return bytes;
  }

  /// Compressed in blocks of 40 bytes. VTK pads the base64 of a compressed array's header.
  std::string Encoded(const std::string& bytes) const {
    const bool as_text = variant_.base64 || variant_.format == std::string("binary");
    if (!variant_.compressed) {
      const std::string all = Header({bytes.size()}) + bytes;
      return as_text ? Base64(all) : all;
    }
    constexpr size_t kBlock = 40;
    std::vector<size_t> header = {(bytes.size() + kBlock - 1) / kBlock, kBlock,
                                  bytes.size() % kBlock};
    std::string data;
    for (size_t at = 0; at < bytes.size(); at += kBlock) {
      const std::string block = bytes.substr(at, kBlock);
      std::string compressed(compressBound(block.size()), '\0');
      uLongf size = compressed.size();
      compress(reinterpret_cast<Bytef*>(compressed.data()), &size,
               reinterpret_cast<const Bytef*>(block.data()), block.size());
      data += compressed.substr(0, size);
      header.push_back(size);
    }
    return as_text ? Base64(Header(header)) + Base64(data) : Header(header) + data;
  }

  const Variant variant_;
  std::string xml_, appended_;
};

/// Two quadrilaterals, a segment and a strip of two triangles, with data.
std::string Mesh(const Variant& variant) {
  VtpWriter writer(variant);
  writer.Xml(
      "<Piece NumberOfPoints=\"6\" NumberOfLines=\"1\" NumberOfPolys=\"2\" "
      "NumberOfStrips=\"1\" NumberOfVerts=\"0\">\n<PointData TCoords=\"uv\">\n");
  writer.Add("Float64", "height", 1, std::vector<double>{0.5, 1, 1.5, 2, 2.5, 3});
  writer.Add("UInt8", "paint", 3,
             std::vector<std::uint8_t>{255, 0, 0, 0, 51, 0, 0, 0, 255, 0, 0, 0, 1, 2, 3, 4, 5, 6});
  writer.Add("Float32", "uv", 2, std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1, 0.5, 0, 0.25, 0});
  writer.Add("Float32", "Normals", 3, std::vector<float>(18));
  writer.Xml("</PointData>\n<CellData>\n");
  writer.Add("Float32", "area", 1, std::vector<float>(4));
  writer.Xml("</CellData>\n<Points>\n");
  writer.Add("Float64", "Points", 3,
             std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0.125, 0, 1, 0, 2, 0, 0, 2, 1, 0});
  writer.Xml("</Points>\n<Lines>\n");
  writer.Index("connectivity", {0, 2});
  writer.Index("offsets", {2});
  writer.Xml("</Lines>\n<Strips>\n");
  writer.Index("connectivity", {0, 1, 3, 2});
  writer.Index("offsets", {4});
  writer.Xml("</Strips>\n<Polys>\n");
  writer.Index("connectivity", {0, 1, 2, 3, 1, 4, 5, 2});
  writer.Index("offsets", {4, 8});
  writer.Xml("</Polys>\n</Piece>\n");
  return writer.Content();
}

std::vector<Variant> AllVariants() {
  std::vector<Variant> variants = {{}};
  for (const auto& [format, base64] :
       {std::make_pair("binary", true), {"appended", true}, {"appended", false}}) {
    for (int bits = 0; bits < 16; ++bits) {
      variants.push_back(
          {format, base64, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0});
    }
  }
  return variants;
}

class ReadVtpTest : public testing::FilesTest {
 protected:
  void Refused(const std::string& content, const std::vector<std::string>& parts) const {
    ExpectError<FileError>([&] { ReadSoup(File("m.vtp", content)); }, parts);
  }
};

TEST_F(ReadVtpTest, AllWaysOfStoringArraysGiveTheSame) {
  for (const Variant& variant : AllVariants()) {
    SCOPED_TRACE(variant.Text());
    const std::string file = File("m.vtp", Mesh(variant));
    const Soup soup = ReadSoup(file);
    ASSERT_EQ(soup.NumVertices(), 6);
    EXPECT_EQ(soup.vertices.col(2), Eigen::Vector3d(1, 1, 0.125));
    EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{0, 2}}));
    EXPECT_EQ(soup.polygon_begin, (std::vector<int>{0, 3, 6, 10, 14}));
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 3, 3, 1, 2, 0, 1, 2, 3, 1, 4, 5, 2}));
    ASSERT_EQ(soup.appearance.vertex_colours.rows(), 3);
    EXPECT_EQ(soup.appearance.vertex_colours.col(1), Eigen::Vector3d(0, 0.2, 0));
    EXPECT_EQ(soup.appearance.texture_coordinates.col(4), Eigen::Vector2d(0.5, 0));
    EXPECT_EQ(soup.appearance.corner_texture, soup.corners);
    EXPECT_EQ(soup.dropped, (std::vector<std::string>{"1 arrays of cell data not kept",
                                                      "point data not kept: height, Normals"}));
    const Eigen::VectorXd height = ReadVertexField(file + ":height");
    EXPECT_EQ(height, Eigen::VectorXd::LinSpaced(6, 0.5, 3));
    ExpectError<FileError>([&] { ReadVertexField(file + ":paint"); }, {"'paint'", "3 components"});
    ExpectError<FileError>([&] { ReadVertexField(file + ":area"); }, {"'area'"});
  }
}

TEST_F(ReadVtpTest, PiecesFollowEachOther) {
  const std::string piece =
      "<Piece NumberOfPoints='3' NumberOfPolys='1'><Points><DataArray type='Float32' "
      "NumberOfComponents='3' format='ascii'>0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>"
      "<DataArray type='Int32' Name='connectivity' format='ascii'>0 1 2</DataArray><DataArray "
      "type='Int32' Name='offsets' format='ascii'>3</DataArray></Polys>";
  const std::string data =
      "<PointData><DataArray type='Int8' Name='a' format='ascii'>1 2 3</DataArray></PointData>";
  const std::string begin = "<VTKFile type='PolyData'><PolyData>";
  const std::string end = "</Piece></PolyData></VTKFile>";
  const std::string all = begin + piece + data + "</Piece>" + piece + data + end;
  EXPECT_EQ(ReadSoup(File("two.vtp", all)).corners, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  Eigen::VectorXd field(6);
  field << 1, 2, 3, 1, 2, 3;
  EXPECT_EQ(ReadVertexField(Path("two.vtp") + ":a"), field);
  File("one.vtp", begin + piece + data + "</Piece>" + piece + end);
  ExpectError<FileError>([&] { ReadVertexField(Path("one.vtp") + ":a"); }, {"'a'", "all pieces"});
}

TEST_F(ReadVtpTest, WhatIsWrongIsNamed) {
  const std::string mesh = Mesh({});
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  Refused("<a/>", {"m.vtp:1", "VTKFile"});
  Refused("<VTKFile type='UnstructuredGrid'/>", {"UnstructuredGrid", "Extract Surface"});
  Refused("<VTKFile type='PolyData'></Polydata>", {"m.vtp:1", "well-formed"});
  Refused("<VTKFile type='PolyData'/>", {"m.vtp", "no point"});
  Refused("<!DOCTYPE a [<!ENTITY b 'c'>]><VTKFile type='PolyData'/>", {"document type"});
  Refused(
      changed(mesh, "type=\"PolyData\"", "type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\""),
      {"vtkLZ4DataCompressor", "ZLib"});
  const std::string high = changed(mesh, "0.125000", "high");
  const auto line = 1 + std::count(high.begin(), high.begin() + high.find("high"), '\n');
  Refused(high, {"m.vtp:" + std::to_string(line) + ":", "'Points'", "'high'"});
  Refused(changed(mesh, "0.125000", "nan"), {"vertex 3", "coordinate z"});
  Refused(changed(mesh, "NumberOfPoints=\"6\"", "NumberOfPoints=\"7\""), {"'Points'", "18", "7"});
  Refused(changed(mesh, "NumberOfPolys=\"2\"", "NumberOfPolys=\"3\""), {"'offsets'", "3 cells"});
  Refused(changed(mesh, "NumberOfPolys=\"2\"", "NumberOfPolys=\"-1\""), {"NumberOfPolys", "'-1'"});
  Refused(changed(mesh, "\n8\n", "\n9\n"), {"polygon 2", "4 to 8"});
  Refused(changed(mesh, "Name=\"offsets\"", "Name=\"offset\""), {"Lines", "'offsets'"});
  Refused(changed(mesh, "type=\"Float64\" Name=\"Points\"", "type=\"String\" Name=\"Points\""),
          {"'Points'", "'String'"});
}

TEST_F(ReadVtpTest, HostileFilesAreRefusedWithoutMuchMemory) {
  const auto file = [](const std::string& attributes, const std::string& array,
                       const std::string& appended) {
    return "<VTKFile type='PolyData' header_type='UInt64' " + attributes +
           "><PolyData><Piece NumberOfPoints='1'><Points><DataArray type='Float64' "
           "Name='Points' " +
           array + "</DataArray></Points></Piece></PolyData><AppendedData encoding='raw'>_" +
           appended;
  };
  const auto header = [](const std::vector<std::uint64_t>& numbers) {
    std::string bytes;
    for (const std::uint64_t number : numbers) internal::AppendLittleEndian(number, &bytes);
    return bytes;
  };
  const std::string at_0 = "format='appended' offset='0'>";
  const std::string zlib = "compressor='vtkZLibDataCompressor'";
  const std::uint64_t huge = std::uint64_t{1} << 62;
  Refused(file("", "format='appended' offset='9'>", header({24})), {"'Points'", "offset '9'"});
  Refused(file("", "format='appended' offset='-1'>", header({24})), {"'Points'", "offset '-1'"});
  Refused(file("", at_0, header({huge})), {"'Points'", "longer than the file"});
  Refused(file("", at_0, header({24, 0})), {"'Points'", "longer than the file"});
  Refused(file("", at_0, header({4}) + "abcd"), {"'Points'", "inside a number"});
  Refused(file(zlib, at_0, header({huge, 8, 0})), {"'Points'", "more blocks"});
  Refused(file(zlib, at_0, header({2, huge, 0, 8, 8})), {"'Points'", "memory"});
  Refused(file(zlib, at_0, header({1, 24, 25, 8})), {"'Points'"});
  Refused(file(zlib, at_0, header({1, 24, 0, huge})), {"'Points'", "longer than the file"});
  Refused(file(zlib, at_0, header({1, 24, 0, 4}) + "abcd"), {"'Points'", "decompressed"});
  Refused(file("", "format='binary'>A", ""), {"'Points'", "longer than the file"});
  Refused(file("", "format='binary'>AAAAA*AAAAAAAAAA", ""), {"'Points'", "not base64"});
  // Many pieces whose points are the same bytes.
  std::string pieces;
  for (int i = 0; i < 300; ++i) {
    pieces +=
        "<Piece NumberOfPoints='20000'><Points><DataArray type='Int8' Name='Points' "
        "format='appended' offset='0'/></Points></Piece>";
  }
  Refused("<VTKFile type='PolyData' header_type='UInt64'><PolyData>" + pieces +
              "</PolyData><AppendedData encoding='raw'>_" + header({60000}) +
              std::string(60000, '\0'),
          {"'Points'", "memory"});
  std::string nested, many = "<VTKFile type='PolyData'>";
  for (int i = 0; i < 100; ++i) nested += "<VTKFile type='PolyData'>";
  for (int i = 0; i < 200000; ++i) many += "<a/>";
  Refused(nested, {"nested more than"});
  Refused(many, {"elements"});
}

}  // namespace
}  // namespace shapespace
