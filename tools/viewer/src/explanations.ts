// What can be done on every kind of page, in the words of the hint and of the help.

export interface Explanation {
  /** One sentence, shown until the page is first touched. */
  hint: string;
  /** Sentences for the help. */
  deeds: string[];
  /** Whether the page plays a motion, and whether it has a plane: both have keys of their own. */
  plays: boolean;
  hasPlane: boolean;
  /** Whether the body can be pulled with the mouse. */
  pulls?: boolean;
}

const view =
  'Drag the picture to turn it, with the wheel or two fingers come nearer, and with the right ' +
  'button or two fingers move it. Roll turns it about your line of sight.';
const saving = 'Save picture and Save film save what you see.';

export function ofPaths(count: number, moves: boolean): Explanation {
  const what = count > 1 ? 'both bodies' : 'the body';
  const motion = [
    'Play, or drag the slider, to see the motion. On the slider blue marks are the poses that were ' +
      'given, green is what was put in between, and violet what goes beyond the last pose.',
    'Colour shows where edges become longer or shorter, where the motion costs its energy (its ' +
      'squared speed), which parts stay rigid, and where the surface passes through itself.',
    'The plots show this for every moment; a click into a plot goes there. Edge lengths are compared ' +
      'with the first shape: near 0\u2009% nothing is stretched.',
  ];
  return {
    hint: moves
      ? `Drag the picture to turn ${what}, and the slider to move along the motion.`
      : `Drag the picture to turn ${what}.`,
    deeds: moves ? [...motion, view, saving] : [view, 'Save picture saves what you see.'],
    plays: moves,
    hasPlane: false,
  };
}

export const ofSpace: Explanation = {
  hint: 'Drag the blue point to mix the poses, or draw a curve through them and play it.',
  deeds: [
    'Drag the blue point: the body is a mixture of the poses around it. Near poses are alike.',
    'Draw a curve, or add points to one, and play it: the body moves along the curve. ' +
      'Save curve as glb saves this motion for other programs.',
    view,
    saving,
  ],
  plays: true,
  hasPlane: true,
};

export const ofModes: Explanation = {
  hint: 'Drag the sliders to change the body, or click a dot to see that pose.',
  deeds: [
    'Each mode is one way in which the poses differ, the strongest first. Drag its slider: at 0 the ' +
      'body is average, and at 1 it differs as poses usually do (by one standard deviation).',
    'Each dot is a pose. Click it to see that pose; the ring is where the body is now.',
    'Play swings the mode that was moved last.',
    'What is shown is a preview. The command writes the exact shape.',
    view,
  ],
  plays: true,
  hasPlane: false,
};

export const ofMesh: Explanation = {
  hint: 'Choose what to pick, then click the body or draw around a part of it; drag to turn it.',
  deeds: [
    'Pick a selection, handles that move, or parts that stand: click vertices one by one, or choose ' +
      'to draw around them. Save writes them as a file, and the command reads it.',
    view,
  ],
  plays: false,
  hasPlane: false,
};

export const ofMarkers: Explanation = {
  hint: 'Click a place on A, then the same place on B; drag to turn both.',
  deeds: [
    'Click a place on one body, then the same place on the other, such as the tip of an ear: both ' +
      'get the same number. One or two pairs settle doubts, and three or more guide the fit alone.',
    'Save writes them as a file. The command reads it, and fits A onto B.',
    view,
  ],
  plays: false,
  hasPlane: false,
};

export const ofSolver: Explanation = {
  hint: 'Drag the picture to turn the body; Pull lets you make another pose of it.',
  deeds: [
    'Drop two or more poses of one mesh: files with the same triangles, whose vertices have moved. ' +
      'The motion between them is computed here and plays as soon as there is a first version, ' +
      'which then becomes finer.',
    'A file with another mesh is refused with a sentence that says what differs. Export all poses ' +
      'from one mesh, with its vertices in one order.',
    'Poses are passed in the order of the list. Other options start the computation again.',
    'The metric says what a motion costs. By strain: as elastic material would move. Isometric: ' +
      'lengths on the surface are kept first of all. Rigid: parts move as if they were solid.',
    'Pull: click the body to set pins, and drag one of them. The rest follows, and what is pinned ' +
      'elsewhere stays. Keep as a pose adds the result to the list, so that one mesh is enough to begin.',
    'Play, or drag the slider, to see the motion. On the slider blue marks are the poses, green is ' +
      'what was put in between, and violet what goes beyond the last pose.',
    view,
    'Save writes the motion as an animated glb, its shapes as a zip of OBJ files, or all of it as a ' +
      '.path file for the other programs of shapespace.',
  ],
  plays: true,
  hasPlane: false,
  pulls: true,
};
