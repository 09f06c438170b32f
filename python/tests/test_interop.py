"""Other packages' meshes and matrices; skipped where a package is not there."""

import numpy as np
import pytest

import shapespace


def test_meshes_of_trimesh(animal):
    trimesh = pytest.importorskip("trimesh")
    meshes = [
        trimesh.Trimesh(animal.pose(name), animal.faces, process=False)
        for name in ("stand", "stride")
    ]
    path, _ = shapespace.interpolate(
        [mesh.vertices for mesh in meshes], meshes[0].faces, shapes=1
    )
    middle = trimesh.Trimesh(path[1], path.faces, process=False)
    assert middle.is_watertight


def test_meshes_of_meshio(animal, tmp_path):
    meshio = pytest.importorskip("meshio")
    for i, name in enumerate(("stand", "stride")):
        meshio.Mesh(animal.pose(name), [("triangle", animal.faces)]).write(tmp_path / f"{i}.vtk")
    meshes = [meshio.read(tmp_path / f"{i}.vtk") for i in range(2)]
    path, _ = shapespace.interpolate(
        [mesh.points for mesh in meshes], meshes[0].cells_dict["triangle"], shapes=1
    )
    meshio.Mesh(path[1], [("triangle", path.faces)]).write(tmp_path / "middle.stl")
    assert len(meshio.read(tmp_path / "middle.stl").cells_dict["triangle"]) == len(animal.faces)


def test_files_for_meshio(path, tmp_path):
    meshio = pytest.importorskip("meshio")
    for extension in ("off", "stl", "ply", "obj"):
        path.write(tmp_path / f"%d.{extension}")
        mesh = meshio.read(tmp_path / f"3.{extension}")
        corners = np.asarray(mesh.points)[mesh.cells_dict["triangle"]]
        np.testing.assert_allclose(corners, path[3][path.faces], atol=1e-6)


def test_series_of_vtk(path, tmp_path):
    """As ParaView reads them."""
    vtk = pytest.importorskip("vtk")
    arrays = pytest.importorskip("vtk.util.numpy_support")
    path.write(tmp_path / "%03d.vtp")
    for i in (0, 3):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(tmp_path / f"{i:03}.vtp"))
        reader.Update()
        mesh = reader.GetOutput()
        points = arrays.vtk_to_numpy(mesh.GetPoints().GetData())
        np.testing.assert_array_equal(points, path[i])
        corners = arrays.vtk_to_numpy(mesh.GetPolys().GetConnectivityArray())
        np.testing.assert_array_equal(corners.reshape(-1, 3), path.faces)
        data = mesh.GetPointData()
        deviation = arrays.vtk_to_numpy(data.GetArray("deviation"))
        np.testing.assert_array_equal(deviation, path.edge_deviation()[i])
        assert arrays.vtk_to_numpy(data.GetArray("energy")).min() >= 0
        assert mesh.GetFieldData().GetArray("TimeValue").GetTuple1(0) == path.parameters[i]


def test_matrices_of_scipy(animal):
    linalg = pytest.importorskip("scipy.sparse.linalg")
    shape = animal.pose("stand")
    metric = shapespace.Metric([shape], animal.faces, bending=1e-3)
    softest, modes = linalg.eigsh(metric.matrix(shape), k=8, sigma=-1e-9)
    order = np.argsort(softest)
    # Rigid motions cost no more than the cost of position, other motions much more.
    assert softest[order[6]] > 5 * softest[order[5]] > 0
    mode = modes[:, order[6]].reshape(-1, 3)
    np.testing.assert_allclose(
        metric.norm(shape, mode) ** 2, softest[order[6]], rtol=1e-5
    )


def test_clusters_of_scipy(animal):
    hierarchy = pytest.importorskip("scipy.cluster.hierarchy")
    distance = pytest.importorskip("scipy.spatial.distance")
    still = [animal.pose(name) for name in ("stand", "sit")]
    shapes = [still[0], still[0] * 1.001 + 1, still[1], still[1] + [0, 0, 3]]
    lengths = shapespace.distance_matrix(shapes, animal.faces, geodesic={"shapes": 1})
    found = hierarchy.fcluster(
        hierarchy.linkage(distance.squareform(lengths), "average"), 2, "maxclust"
    )
    assert found[0] == found[1] != found[2] == found[3]
