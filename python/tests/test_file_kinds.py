"""Files of VTK, USD and landmarks."""

import json

import numpy as np
import pytest

import shapespace


def test_series_of_vtk_are_poses_again(path, tmp_path):
    path.write(tmp_path / "%03d.vtp")
    poses = shapespace.read(tmp_path / "000.vtp", tmp_path / "003.vtp")
    np.testing.assert_array_equal(poses[1], path[3])
    np.testing.assert_array_equal(poses.faces, path.faces)
    deviation = shapespace.read_vertex_field(f"{tmp_path}/003.vtp:deviation")
    np.testing.assert_array_equal(deviation, path.edge_deviation()[3])


def test_all_files_that_vtk_writes_are_read(path, tmp_path):
    vtk = pytest.importorskip("vtk")
    arrays = pytest.importorskip("vtk.util.numpy_support")
    mesh = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(arrays.numpy_to_vtk(path[1], deep=True))
    mesh.SetPoints(points)
    cells = vtk.vtkCellArray()
    for face in path.faces:
        cells.InsertNextCell(3, [int(corner) for corner in face])
    mesh.SetPolys(cells)
    height = arrays.numpy_to_vtk(path[1][:, 1].copy(), deep=True)
    height.SetName("height of it")
    mesh.GetPointData().AddArray(height)

    def check(file):
        poses = shapespace.read(file)
        np.testing.assert_array_equal(poses[0], path[1])
        np.testing.assert_array_equal(poses.faces, path.faces)
        field = shapespace.read_vertex_field(f"{file}:height of it")
        np.testing.assert_array_equal(field, path[1][:, 1])

    for mode in ("Ascii", "Binary", "Appended"):
        for compressor in ("None", "ZLib"):
            for order in ("LittleEndian", "BigEndian"):
                for bits in (32, 64):
                    for base64 in (False, True):
                        writer = vtk.vtkXMLPolyDataWriter()
                        writer.SetInputData(mesh)
                        writer.SetFileName(str(tmp_path / "mesh.vtp"))
                        getattr(writer, f"SetDataModeTo{mode}")()
                        getattr(writer, f"SetCompressorTypeTo{compressor}")()
                        getattr(writer, f"SetByteOrderTo{order}")()
                        getattr(writer, f"SetHeaderTypeToUInt{bits}")()
                        writer.SetEncodeAppendedData(base64)
                        writer.Write()
                        check(tmp_path / "mesh.vtp")
    grid = vtk.vtkAppendFilter()
    grid.AddInputData(mesh)
    for version in (42, 51):
        for binary in (False, True):
            for writer, output in (
                (vtk.vtkPolyDataWriter(), None),
                (vtk.vtkUnstructuredGridWriter(), grid.GetOutputPort()),
            ):
                writer.SetInputData(mesh) if output is None else writer.SetInputConnection(output)
                writer.SetFileName(str(tmp_path / "mesh.vtk"))
                writer.SetFileVersion(version)
                writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
                writer.Write()
                if binary:
                    check(tmp_path / "mesh.vtk")
                else:  # VTK writes fewer digits than a double has
                    poses = shapespace.read(tmp_path / "mesh.vtk")
                    np.testing.assert_allclose(poses[0], path[1], atol=1e-5)
                    np.testing.assert_array_equal(poses.faces, path.faces)


def test_usd_takes_options_of_its_own(path, tmp_path):
    path.write(tmp_path / "walk.usda", fps=30, up="z", unit=0.01, color="deviation")
    text = (tmp_path / "walk.usda").read_text()
    for words in ("timeCodesPerSecond = 30\n", 'upAxis = "Z"', "metersPerUnit = 0.01\n"):
        assert words in text
    assert f"endTimeCode = {len(path) - 1}\n" in text
    assert "primvars:displayColor.timeSamples" in text
    with pytest.raises(ValueError, match="up"):
        path.write(tmp_path / "walk.usda", up="north")
    with pytest.raises(TypeError, match="frames"):
        path.write(tmp_path / "walk.usda", frames=3)


def test_landmarks_are_markers(animal, tmp_path):
    poses = shapespace.Poses([animal.pose("stand")], animal.faces)
    vertices = np.array([3, 100, 250, 400])
    places = poses[0][vertices]
    np.savetxt(tmp_path / "plain.txt", places)
    points = [
        {"label": f"L{i}", "position": list(place * (-1, -1, 1))} for i, place in enumerate(places)
    ]
    points.append({"label": "extra", "position": [0, 0, 0]})
    markups = {"markups": [{"coordinateSystem": "RAS", "controlPoints": points[:4]}]}
    (tmp_path / "ras.mrk.json").write_text(json.dumps(markups))
    files = tmp_path / "plain.txt", str(tmp_path / "ras.mrk.json")
    markers = shapespace.read_markers(files, poses, poses)
    np.testing.assert_array_equal(markers, np.column_stack([vertices, vertices]))

    markups["markups"][0]["controlPoints"] = points
    (tmp_path / "more.mrk.json").write_text(json.dumps(markups))
    with pytest.warns(UserWarning, match="'extra' was ignored"):
        markers = shapespace.read_markers([files[1], tmp_path / "more.mrk.json"], poses, poses)
    np.testing.assert_array_equal(markers[:, 1], vertices)
    with pytest.raises(shapespace.FileError, match="landmarks"):
        shapespace.read_markers([files[0], tmp_path / "more.mrk.json"], poses, poses)
    with pytest.raises(ValueError, match="two files"):
        shapespace.read_markers([files[0]], poses, poses)
