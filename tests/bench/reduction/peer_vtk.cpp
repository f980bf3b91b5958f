// VTK as a peer: vtkQuadricDecimation by position, and with its attribute error metric for colours.
#include <array>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkSmartPointer.h>
#include <vtkVersion.h>

#include "tests/bench/reduction/peer.h"

namespace merlin::bench {
namespace {

template <typename T>
using Pointer = vtkSmartPointer<T>;

// VTK's attribute quadrics treat small triangles as singular, by an absolute threshold, and weigh
// attributes in absolute units. The mesh is therefore scaled to this diagonal, and scaled back
// afterwards.
constexpr double kDiagonal = 1000;

double scaleOf(const render::mesh::Mesh& mesh) {
  return kDiagonal / double{render::mesh::boundingBox(mesh.positions).diagonal()};
}

Pointer<vtkPolyData> polyData(const render::mesh::Mesh& mesh, bool with_colours) {
  const auto points = Pointer<vtkPoints>::New();
  const double scale = scaleOf(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float* p = &mesh.positions[3 * v];
    points->InsertNextPoint(scale * p[0], scale * p[1], scale * p[2]);
  }
  const auto cells = Pointer<vtkCellArray>::New();
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::array<vtkIdType, 3> corners{mesh.triangles[t], mesh.triangles[t + 1],
                                           mesh.triangles[t + 2]};
    cells->InsertNextCell(3, corners.data());
  }
  auto data = Pointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  if (with_colours) {
    const auto& colours = mesh.find("colour")->values;
    const auto scalars = Pointer<vtkFloatArray>::New();
    scalars->SetNumberOfComponents(3);
    for (std::size_t i = 0; i < colours.size(); i += 3) scalars->InsertNextTypedTuple(&colours[i]);
    data->GetPointData()->SetScalars(scalars);
  }
  return data;
}

class VtkPeer : public Peer {
 public:
  VtkPeer(const render::mesh::Mesh& mesh, double colour_weight)
      : input_(polyData(mesh, colour_weight > 0)),
        triangles_(mesh.triangleCount()),
        scale_(scaleOf(mesh)) {
    decimation_->SetInputData(input_);
    if (colour_weight == 0) return;
    decimation_->AttributeErrorMetricOn();
    decimation_->ScalarsAttributeOn();
    decimation_->SetScalarsWeight(colour_weight * kDiagonal);
    for (auto set :
         {&vtkQuadricDecimation::SetVectorsAttribute, &vtkQuadricDecimation::SetNormalsAttribute,
          &vtkQuadricDecimation::SetTCoordsAttribute, &vtkQuadricDecimation::SetTensorsAttribute}) {
      (decimation_->*set)(false);
    }
  }

  void reduce(std::size_t triangles) override {
    decimation_->SetTargetReduction(1 - static_cast<double>(triangles) /
                                            static_cast<double>(triangles_));
    decimation_->Update();
  }

  render::mesh::Mesh result() override {
    vtkPolyData* output = decimation_->GetOutput();
    render::mesh::Mesh mesh;
    for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v) {
      const double* p = output->GetPoint(v);
      for (int k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(p[k] / scale_));
    }
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    for (output->GetPolys()->InitTraversal(); output->GetPolys()->GetNextCell(count, corners);) {
      for (int k = 0; k < 3; ++k) mesh.triangles.push_back(static_cast<std::uint32_t>(corners[k]));
    }
    if (vtkDataArray* scalars = output->GetPointData()->GetScalars()) {
      render::mesh::Feature colour{"colour", 3, {}};
      for (vtkIdType v = 0; v < scalars->GetNumberOfTuples(); ++v) {
        for (int k = 0; k < 3; ++k) {
          colour.values.push_back(static_cast<float>(scalars->GetComponent(v, k)));
        }
      }
      mesh.features.push_back(std::move(colour));
    }
    return mesh;
  }

 private:
  Pointer<vtkPolyData> input_;
  Pointer<vtkQuadricDecimation> decimation_ = Pointer<vtkQuadricDecimation>::New();
  std::size_t triangles_;
  double scale_;
};

// The prefix of a variant; after it comes the weight of colours, as a share of the diagonal.
constexpr std::string_view kColour = "colour=";

Result<std::unique_ptr<Peer>> make(render::mesh::Mesh mesh, const std::string& variant) {
  if (variant == "plain") return std::unique_ptr<Peer>(new VtkPeer(mesh, 0));
  if (variant.rfind(kColour, 0) != 0) {
    return Error{Errc::kInvalidArgument, variant + ": is not plain or colour=WEIGHT"};
  }
  if (!mesh.find("colour")) return Error{Errc::kUnsupported, "the mesh has no colours"};
  const double weight = std::strtod(variant.c_str() + kColour.size(), nullptr);
  return std::unique_ptr<Peer>(new VtkPeer(mesh, weight));
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  const std::string version = fmt::format("VTK {}", vtkVersion::GetVTKVersion());
  return merlin::bench::runPeer(argc, argv, version.c_str(), merlin::bench::make);
}
