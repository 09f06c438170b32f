"""Markers: how they are made, and what Fit To makes of them."""

import bmesh
import bpy
import numpy as np
from shapespace_addon import markers
from support import CUBE, CUBE_FACES, Case, add_key, add_object, assign, seen, select

PLATE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]
PLATE_FACES = [[0, 1, 2, 3], [1, 4, 2]]


def table(cells):
    """A table of size 3 x 2 x 1.5, made of squares of which so many are in a length of 1. It looks
    the same from opposite sides."""
    wide, deep, high, leg = 3 * cells, 2 * cells, cells, cells // 2
    solid = np.zeros((wide, deep, high + leg), bool)
    solid[:, :, high:] = True
    for x in (slice(0, leg), slice(wide - leg, wide)):
        for y in (slice(0, leg), slice(deep - leg, deep)):
            solid[x, y] = True
    solid = np.pad(solid, 1)
    numbers, faces = {}, []
    for cell in np.argwhere(solid):
        for axis in range(3):
            for side in (0, 1):
                step = np.eye(3, dtype=int)
                if solid[tuple(cell + (2 * side - 1) * step[axis])]:
                    continue
                first = cell + side * step[axis]
                one, two = step[(axis + 1) % 3], step[(axis + 2) % 3]
                corners = [first, first + one, first + one + two, first + two]
                face = [numbers.setdefault(tuple(corner), len(numbers)) for corner in corners]
                faces.append(face if side else face[::-1])
    return (np.array(list(numbers)) - 1) / cells, faces


def edit(*chosen):
    """Changes to Edit Mode, in which of each object the vertices of these numbers are selected."""
    select(*(item for item, _ in chosen))
    bpy.ops.object.mode_set(mode="EDIT")
    for item, vertices in chosen:
        content = bmesh.from_edit_mesh(item.data)
        for vertex in content.verts:
            vertex.select_set(vertex.index in vertices)
        content.select_flush_mode()
        bmesh.update_edit_mesh(item.data)


def mark(item, vertex, other, others_vertex):
    edit((item, [vertex]), (other, [others_vertex]))
    assert bpy.ops.shapespace.marker_add() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")


def groups(item):
    """The vertices of each group by its name, with their weights."""
    return {
        group.name: {
            vertex.index: of.weight
            for vertex in item.data.vertices
            for of in vertex.groups
            if of.group == group.index
        }
        for group in item.vertex_groups
    }


class AddMarker(Case):
    def two(self):
        return add_object("cube", CUBE, CUBE_FACES), add_object("plate", PLATE, PLATE_FACES)

    def test_both_get_a_group_of_one_name_with_the_selected_vertex(self):
        cube, plate = self.two()
        mark(cube, 3, plate, 4)
        (name,) = groups(cube)
        self.assertEqual((groups(cube), groups(plate)), ({name: {3: 1}}, {name: {4: 1}}))
        mark(cube, 5, plate, 0)
        _, second = groups(cube)
        self.assertEqual(groups(cube), {name: {3: 1}, second: {5: 1}})
        self.assertEqual(groups(plate), {name: {4: 1}, second: {0: 1}})

    def test_the_name_is_free_in_both(self):
        cube, plate = self.two()
        other = add_object("other", PLATE, PLATE_FACES)
        mark(plate, 1, other, 2)
        mark(cube, 3, plate, 4)
        self.assertEqual(list(groups(cube).values()), [{3: 1}])
        self.assertEqual(list(groups(plate).values()), [{1: 1}, {4: 1}])
        self.assertEqual(list(groups(cube)), list(groups(plate))[1:])

    def test_other_groups_stay(self):
        cube, plate = self.two()
        assign(cube, "bone", np.arange(8) < 2)
        mark(cube, 1, plate, 0)
        self.assertEqual(list(groups(cube).values()), [{0: 1, 1: 1}, {1: 1}])

    def test_is_one_step_of_undo(self):
        cube, plate = self.two()
        bpy.ops.ed.undo_push(message="made")
        edit((cube, [3]), (plate, [4]))
        bpy.ops.ed.undo_push(message="selected")
        bpy.ops.shapespace.marker_add("EXEC_DEFAULT", True)

        def weighted():
            bpy.ops.object.mode_set(mode="OBJECT")
            found = [groups(bpy.data.objects[name]) for name in ("cube", "plate")]
            bpy.ops.object.mode_set(mode="EDIT")
            return [[members for members in of.values() if members] for of in found]

        bpy.ops.ed.undo()
        self.assertEqual(weighted(), [[], []])
        bpy.ops.ed.redo()
        self.assertEqual(weighted(), [[{3: 1}], [{4: 1}]])

    def test_what_is_missing(self):
        cube, plate = self.two()
        twin = bpy.data.objects.new("twin", cube.data)
        bpy.context.scene.collection.objects.link(twin)
        add = bpy.ops.shapespace.marker_add
        select(cube, plate)
        self.assertFalse(add.poll())
        for chosen in ([(cube, [3])], [(cube, [3]), (twin, [3])]):
            edit(*chosen)
            self.assertFalse(add.poll())
            bpy.ops.object.mode_set(mode="OBJECT")
        for chosen in ([], [0, 1]):
            edit((cube, chosen), (plate, [4]))
            self.refused(f"{len(chosen)} vertices of 'cube'", add)
            bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual((groups(cube), groups(plate)), ({}, {}))


class MarkersOfTwo(Case):
    """What Fit To reads."""

    def setUp(self):
        super().setUp()
        self.cube = add_object("cube", CUBE, CUBE_FACES)
        self.plate = add_object("plate", PLATE, PLATE_FACES)
        mark(self.cube, 3, self.plate, 4)
        (self.name,) = groups(self.cube)
        select(self.plate, self.cube)

    def places(self):
        """Where the marked vertices are in the meshes as they are seen."""
        pairs, notes = markers.pairs_of(bpy.context, self.cube, self.plate)
        self.assertEqual(notes, [])
        (vertices,) = pairs.values()
        return [seen(item, 1)[v] for item, v in zip((self.cube, self.plate), vertices)]

    def test_vertices_are_those_of_the_meshes_as_they_are_seen(self):
        self.near(self.places(), [CUBE[3], PLATE[4]])
        # Vertices before the marked one are gone.
        assign(self.cube, "hidden", np.arange(8) < 1)
        mask = self.cube.modifiers.new("mask", "MASK")
        mask.vertex_group, mask.invert_vertex_group = "hidden", True
        self.assertEqual(len(seen(self.cube, 1)), 7)
        self.near(self.places(), [CUBE[3], PLATE[4]])
        # Faces are divided, and copied.
        subdivision = self.plate.modifiers.new("subdivision", "SUBSURF")
        subdivision.subdivision_type, subdivision.levels = "SIMPLE", 2
        self.plate.modifiers.new("mirror", "MIRROR")
        self.near(self.places(), [CUBE[3], PLATE[4]])
        # A shape key moves the vertex.
        moved = np.array(PLATE, float)
        moved[4] += (0, 0, 1)
        add_key(self.plate, "up", moved).value = 1
        self.near(self.places(), [CUBE[3], moved[4]])

    def test_a_modifier_that_removes_the_vertex_is_refused(self):
        assign(self.cube, "hidden", np.arange(8) == 3)
        mask = self.cube.modifiers.new("mask", "MASK")
        mask.vertex_group, mask.invert_vertex_group = "hidden", True
        self.refused(f"'cube'.*'{self.name}'", bpy.ops.shapespace.fit)

    def test_a_group_of_two_vertices_is_refused(self):
        assign(self.plate, self.name, np.arange(5) < 1)
        self.refused(f"2 vertices of 'plate'.*'{self.name}'", bpy.ops.shapespace.fit)

    def test_two_markers_on_one_vertex_are_refused(self):
        mark(self.cube, 5, self.plate, 4)
        select(self.plate, self.cube)
        first, second = groups(self.plate)
        self.refused(f"'{first}'.*'{second}'.*'plate'", bpy.ops.shapespace.fit)

    def test_a_marker_of_one_object_alone_is_named(self):
        other = add_object("other", PLATE, PLATE_FACES)
        mark(self.plate, 1, other, 2)
        first, second = groups(self.plate)
        pairs, (note,) = markers.pairs_of(bpy.context, self.cube, self.plate)
        self.assertEqual(pairs, {first: (3, 4)})
        self.assertRegex(note, f"'plate'.*'{second}'.*'cube'")
        self.assertNotIn(f"'{first}'", note)
        # So is one that has lost its vertex.
        self.cube.vertex_groups[first].remove([3])
        pairs, (note,) = markers.pairs_of(bpy.context, self.cube, self.plate)
        self.assertEqual(pairs, {})
        self.assertRegex(note, f"'plate'.*'{first}', '{second}'.*'cube'")

    def test_other_groups_are_no_markers(self):
        for item in (self.cube, self.plate):
            item.vertex_groups[0].name = "bone"
        self.assertEqual(markers.pairs_of(bpy.context, self.cube, self.plate), ({}, []))


class FitByMarkers(Case):
    def tables(self):
        """A template, and a target of other faces and proportions at another place. One of two maps
        is as good as the other."""
        template = add_object("template", *table(4))
        target = add_object("target", *table(6))
        target.location, target.scale = (5, 1, 0), (1, 1, 1.5)
        return template, target

    def vertex_at(self, item, place):
        return int(np.linalg.norm(seen(item, 1) - place, axis=1).argmin())

    def test_one_marker_decides_between_maps_that_are_equally_good(self):
        template, target = self.tables()
        foot, beside = (self.vertex_at(template, place) for place in ((0, 0, 0), (3, 0, 0)))
        for goal, goal_beside in (((0, 0, 0), (3, 0, 0)), ((3, 2, 0), (0, 2, 0))):
            template.vertex_groups.clear()
            target.vertex_groups.clear()
            mark(template, foot, target, self.vertex_at(target, goal))
            select(target, template)
            bpy.ops.shapespace.fit()
            places = seen(bpy.context.active_object, 1)
            self.near(places[foot], goal)
            self.near(places[beside], goal_beside, 0.3)

    def test_further_ones_are_found_beside_a_few(self):
        template, target = self.tables()
        foot, beside = (self.vertex_at(template, place) for place in ((0, 0, 0), (3, 0, 0)))
        for place in ((0, 0, 0), (0, 0, 0.25), (0.25, 0, 0)):
            goal = (3 - place[0], 2, 1.5 * place[2])
            mark(template, self.vertex_at(template, place), target, self.vertex_at(target, goal))
        select(target, template)
        bpy.ops.shapespace.fit()
        places = seen(bpy.context.active_object, 1)
        self.near(places[foot], (3, 2, 0), 0.3)
        self.near(places[beside], (0, 2, 0), 0.3)

    def test_where_there_is_doubt_it_is_said_how_to_decide(self):
        template, target = self.tables()
        select(target, template)
        begun = self.begin("FitOnto")
        begun.wait()
        self.assertRegex(begun.finish(bpy.context)[-1], "'template'.*'target'.*Add Marker")

    def test_what_is_said_of_a_marker_has_its_name(self):
        template, target = self.tables()
        mark(template, 0, target, 0)
        (name,) = groups(template)
        template.data.vertices.add(1)
        loose = len(template.data.vertices) - 1
        template.vertex_groups[name].remove([0])
        template.vertex_groups[name].add([loose], 1, "REPLACE")
        select(target, template)
        self.refused(f"'{name}'", bpy.ops.shapespace.fit)
