"""A body that is fitted onto another one, of other faces."""

import bpy
import numpy as np
from mathutils import Matrix
from mathutils.bvhtree import BVHTree
from support import (
    CUBE,
    CUBE_FACES,
    Case,
    add_object,
    children,
    key_names,
    placed,
    seen,
    select,
    state,
    temporary_folders,
)


class Fit(Case):
    def bodies(self):
        """A template, and a target of other faces, proportions and pose at another place."""
        (stand,), faces = self.quadruped("stand")
        (stride,), others = self.quadruped("stride", triangles=2500, proportions="heavy")
        target = add_object("target", stride, others)
        target.matrix_world = Matrix.Translation((7, 1, 2)) @ Matrix.Rotation(1, 4, "Z")
        template = add_object("template", stand, faces)
        select(target, template)
        return template, target

    def fit(self, **options):
        self.assertEqual(bpy.ops.shapespace.fit(**options), {"FINISHED"})
        return bpy.data.objects["template as target"]

    def faces(self, item):
        return [list(face.vertices) for face in item.data.polygons]

    def test_the_templates_faces_get_the_targets_shape_where_it_stands(self):
        template, target = self.bodies()
        before = {item.name: seen(item, 1).tolist() for item in (template, target)}
        fitted = self.fit()
        self.assertEqual(self.faces(fitted), self.faces(template))
        shape = placed(target, seen(target, 1))
        surface = BVHTree.FromPolygons(shape.tolist(), self.faces(target))
        vertices = placed(fitted, seen(fitted, 1))
        away = [surface.find_nearest(vertex)[3] for vertex in vertices.tolist()]
        size = np.linalg.norm(np.ptp(shape, axis=0))
        self.assertLess(max(away), 0.03 * size)
        # And all of it, which a template that lies on one limb would not reach.
        for k in (np.min, np.max):
            self.near(k(vertices, axis=0), k(shape, axis=0), 0.05 * size)
        self.assertEqual({item.name: seen(item, 1).tolist() for item in (template, target)}, before)
        shown = bpy.context.window_manager.shapespace_report
        self.assertEqual(shown.title, "Fit To")
        self.assertIn("Round trip, mean", [figure.name for figure in shown.figures])

    def test_materials_and_uvs_are_the_templates(self):
        template, _ = self.bodies()
        for name in ("fur", "paw"):
            template.data.materials.append(bpy.data.materials.new(name))
        for face in template.data.polygons:
            face.material_index = face.index % 2
        layer = template.data.uv_layers.new(name="skin")
        corners = np.random.default_rng(1).random(2 * len(template.data.loops)).astype("f4")
        layer.data.foreach_set("uv", corners)
        fitted = self.fit()
        self.assertEqual([m.name for m in fitted.data.materials], ["fur", "paw"])
        self.assertEqual(
            [face.material_index for face in fitted.data.polygons],
            [face.material_index for face in template.data.polygons],
        )
        kept = np.empty_like(corners)
        fitted.data.uv_layers["skin"].data.foreach_get("uv", kept)
        self.near(kept, corners)

    def test_in_betweens_then_take_both(self):
        template, _ = self.bodies()
        fitted = self.fit()
        self.assertEqual(
            {item.name for item in bpy.context.selected_objects}, {template.name, fitted.name}
        )
        self.inbetweens(shapes=1)
        moving = bpy.context.active_object
        self.assertEqual(key_names(moving), ["template", "template as target", "geo 001"])
        self.near(placed(moving, seen(moving, 3)), placed(fitted, seen(fitted, 1)), 1e-4)

    def test_what_is_missing(self):
        fit = bpy.ops.shapespace.fit
        cube = add_object("cube", CUBE, CUBE_FACES)
        self.refused("onto which 'cube' is to be fitted", fit)
        others = [add_object(name, CUBE, CUBE_FACES) for name in ("one", "two")]
        select(*others, cube)
        self.refused("onto which 'cube' is to be fitted", fit)
        select(cube)
        bpy.context.view_layer.objects.active = None
        self.refused("The active object is no mesh", fit)
        others[0].scale = (-1, 1, 1)
        select(others[0], cube)
        self.refused("'cube' or 'one' is mirrored", fit)
        wire = add_object("wire", CUBE, [], edges=[(0, 1), (1, 3)])
        select(wire, cube)
        self.refused("shape-correspond: ", fit)

    def test_a_cancelled_fit_leaves_nothing_behind(self):
        self.bodies()
        before = state()
        begun = self.begin("FitOnto")
        self.wait_for(lambda: begun.poll() or begun.text)
        begun.cancel()
        self.assertEqual(temporary_folders(), [])
        self.assertEqual(children(), [])
        self.assertEqual(state(), before)

    def test_other_operators_name_it(self):
        template, target = self.bodies()
        self.refused("Fit To .*'target'.*'template'", bpy.ops.shapespace.inbetweens)
