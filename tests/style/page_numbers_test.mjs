// tests/style/page_numbers_test.mjs -- numbers that C++ and the page both write are equal.
//
// usage: node page_numbers_test.mjs SOURCE_FOLDER
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';

const root = process.argv[2];

/** The numbers of what `pattern` has in parentheses in a file, which holds it once. */
function numbersIn(file, pattern) {
  const found = [...readFileSync(join(root, file), 'utf8').matchAll(new RegExp(pattern, 'gs'))];
  assert.equal(found.length, 1, `${file} has ${found.length} places of ${pattern}`);
  const [, ...groups] = found[0];
  const text = groups.join(' ').replace(/(?<=\d)['_](?=\d)/g, '');
  const numbers = text.match(/0x[0-9a-f]+|-?\d+(?:\.\d+)?(?:e[+-]?\d+)?/gi) ?? [];
  assert.ok(numbers.length > 0, `${file}: no number in '${text}'`);
  return numbers.map(Number);
}

const cpp = (file, name) => [`viz_node/${file}`, `\\bconstexpr [\\w:]+ ${name} = ([^;]*);`];
const page = (file, name) => [`viz_node/web/page/${file}`, `\\bconst ${name} = ([^;]*);`];
const readme = (pattern) => ['viz_node/web/README.md', pattern];

const ENCODER = 'frame_encoder.h';
const CAMERA = 'render/view_camera.cpp';
const PAINTER = 'render/scene_painter.cpp';
const COLOURING = 'render/colouring.cpp';
const SHAPE = 'render/surface_shape.cpp';
const enumerator = (name) => [`viz_node/${ENCODER}`, `\\b${name} = (\\d+)`];

// Places that have the same numbers.
const EQUAL = {
  'magic of a message': [cpp(ENCODER, 'kMagic'), page('protocol.ts', 'MAGIC')],
  'version of the protocol': [cpp(ENCODER, 'kProtocolVersion'), page('protocol.ts', 'VERSION'), readme('`u8` version \\((\\d+)\\)')],
  'a link without states': [cpp(ENCODER, 'kNoStateMachine'), page('protocol.ts', 'NO_STATE_MACHINE')],
  'type of a frame': [enumerator('kFrame'), page('protocol.ts', 'TYPE_FRAME'), readme('frame \\(type (\\d+)\\)')],
  'type of signals': [enumerator('kSignals'), page('protocol.ts', 'TYPE_SIGNALS'), readme('signals \\(type (\\d+)\\)')],
  'type of a topology': [enumerator('kTopology'), page('protocol.ts', 'TYPE_TOPOLOGY'), readme('topology \\(type (\\d+)\\)')],
  'type of sound': [enumerator('kSound'), page('protocol.ts', 'TYPE_SOUND'), readme('sound \\(type (\\d+)')],
  'header of a frame': [cpp(ENCODER, 'kFrameHeaderBytes'), readme('frame \\(type 1\\), header (\\d+) bytes')],
  'header of signals': [cpp(ENCODER, 'kSignalsHeaderBytes'), readme('signals \\(type 2\\), header (\\d+) bytes')],
  'header of a topology': [cpp(ENCODER, 'kTopologyHeaderBytes'), readme('topology \\(type 3\\), header (\\d+) bytes')],
  'header of sound': [cpp(ENCODER, 'kSoundHeaderBytes'), readme('sound \\(type 4\\), header (\\d+) bytes')],
  'room around a fitted scene': [cpp(CAMERA, 'kMargin'), page('camera_rig.ts', 'ROOM')],
  'growth that the camera follows': [cpp('render/film_view.cpp', 'kMaxGrowth'), page('camera_rig.ts', 'FARTHEST')],
  'outliers that a view does not follow': [cpp('render/scene_painter.h', 'kOutliers'), page('scene_view.ts', 'OUTLIERS')],
  'view from the front': [[`viz_node/${CAMERA}`, 'kFront:\\s+return \\{([^}]*)\\}'], ['viz_node/web/page/camera_rig.ts', 'front: new Vector3\\(([^)]*)\\)']],
  'view from the side': [[`viz_node/${CAMERA}`, 'kSide:\\s+return \\{([^}]*)\\}'], ['viz_node/web/page/camera_rig.ts', 'side: new Vector3\\(([^)]*)\\)']],
  'view from the top': [[`viz_node/${CAMERA}`, 'kTop:\\s+return normalized\\(\\{([^}]*)\\}'], ['viz_node/web/page/camera_rig.ts', 'top: new Vector3\\(([^)]*)\\)']],
  'free view': [[`viz_node/${CAMERA}`, 'break;\\s+\\}\\s+return normalized\\(\\{([^}]*)\\}'], ['viz_node/web/page/camera_rig.ts', 'free: new Vector3\\(([^)]*)\\)']],
  'room of a surface': [cpp(SHAPE, 'kSurfaceRoom'), page('surface_shape.ts', 'SURFACE_ROOM')],
  'room of a flat surface': [cpp(SHAPE, 'kFlatRoom'), page('surface_shape.ts', 'FLAT_ROOM')],
  'cells of a plane': [cpp(SHAPE, 'kPlaneCells'), page('surface_shape.ts', 'PLANE_CELLS')],
  'length of a hatch': [cpp(SHAPE, 'kHatchLength'), page('surface_shape.ts', 'HATCH_LENGTH')],
  'where nothing unbounded counts': [cpp(SHAPE, 'kNearDiagonals'), page('surface_shape.ts', 'NEAR_DIAGONALS')],
  'corners of a circle': [cpp(SHAPE, 'kCircleCorners'), page('surface_shape.ts', 'CIRCLE_CORNERS')],
  'light on a surface': [[`viz_node/${SHAPE}`, 'return std::min\\(1\\.0, ([\\d.]+) \\+ ([\\d.]+) \\* normal\\[1\\] \\+ ([\\d.]+) '],
    ['viz_node/web/page/surface_shape.ts', 'Math\\.min\\(1, ([\\d.]+) \\+ ([\\d.]+) \\* normal\\.y \\+ ([\\d.]+) ']],
  'lamp of surfaces': [[`viz_node/${SHAPE}`, 'key = dot\\(normal, normalized\\(\\{([^}]*)\\}'], ['viz_node/web/page/surface_shape.ts', 'LIGHT = new Vector3\\(([^)]*)\\)']],
  'edge of a surface': [cpp(PAINTER, 'kEdgeShare'), page('surfaces.ts', 'EDGE_SHARE')],
  'cells of the grid': [cpp(PAINTER, 'kGridCells'), page('ground.ts', 'CELLS')],
  'few MATs': [cpp(PAINTER, 'kFewMats'), ['viz_node/web/page/scene_view.ts', 'few = this\\.topology\\.matCount <= (\\d+)']],
  'fade of a full scale': [cpp(COLOURING, 'kFade'), page('scene_view.ts', 'FALL'), page('link_view.ts', 'FALL')],
  'size of balls beside links': [cpp(COLOURING, 'kSmallShare'), page('scene_view.ts', 'SMALL')],
  'components with colours': [cpp('render/components.h', 'kMaxColoured'), page('components.ts', 'MAX_COLOURED')],
  'frames that give a force': [cpp('render/net_forces.cpp', 'kMinApart'), page('net_forces.ts', 'MIN_APART_S')],
  'least contrast': [cpp('render/palette.h', 'kMinContrast'), page('colours.ts', 'MIN_CONTRAST')],
  'steps to a readable colour': [cpp('render/palette.cpp', 'kSteps'), page('colours.ts', 'STEPS')],
  'matter without a colour of the scene': [cpp('render/scene_colours.h', 'kNone'), page('given_colours.ts', 'NONE')],
  'prefixes of units': [['viz_node/render/number_text.cpp', 'kPrefixes = \\{(.*?)\\};'], ['viz_node/web/page/format.ts', 'PREFIXES: [^=]*= \\[(.*?)\\];']],
};

for (const [what, places] of Object.entries(EQUAL)) {
  test(`${what}: one number`, () => {
    const [first, ...others] = places;
    const wanted = numbersIn(...first);
    for (const other of others) assert.deepEqual(numbersIn(...other), wanted, `${other[0]}, and ${first[0]}`);
  });
}

test('sizes and dashes of marks: the page has those of images', () => {
  const least = numbersIn('viz_node/web/page/scene_view.ts', 'least = few \\? \\[([^\\]]*)\\] : \\[([^\\]]*)\\]');
  const sizes = ['kFewSizes', 'kManySizes'].flatMap((name) => numbersIn(`viz_node/${PAINTER}`, `\\b${name} = \\{([^}]*)\\}`).slice(0, 4));
  assert.deepEqual(least, sizes);
  const [, , dash, dashOn, dot, dotOn] = numbersIn('viz_node/render/line_pattern.cpp', 'kDashes\\{\\{(.*?)\\}\\};');
  const shader = ['viz_node/web/page/mat_material.ts', 'mod\\(along, ([\\d.]+)\\) > ([\\d.]+) : pattern > 0\\.5 && mod\\(along, ([\\d.]+)\\) > ([\\d.]+)'];
  assert.deepEqual(numbersIn(...shader), [dot, dotOn, dash, dashOn]);
});

test('the camera: half of the field of view has that tangent', () => {
  const [degrees] = numbersIn(...page('camera_rig.ts', 'FIELD_OF_VIEW'));
  const [tangent] = numbersIn(...cpp(CAMERA, 'kHalfField'));
  assert.ok(Math.abs(Math.tan((degrees * Math.PI) / 360) - tangent) < 1e-15);
});

test('a page that drags repeats itself often enough, and is given up after the silence that it expects', () => {
  const [repeatMs] = numbersIn(...page('pointer.ts', 'REPEAT_MS'));
  const [silenceNsec] = numbersIn(...cpp('pointer_server.h', 'kSilenceNsec'));
  assert.ok(4 * repeatMs * 1e6 <= silenceNsec);
  const [saidMs] = numbersIn('viz_node/web/page/pointer.ts', 'says nothing for longer than (\\d+) ms');
  assert.equal(saidMs * 1e6, silenceNsec);
  const [pageSilence] = numbersIn('device_node/drivers/pointer_port.h', 'kPageSilence = ([\\d.]+);');
  assert.equal(pageSilence * 1e9, silenceNsec);
});

test('the page asks for the path that viz_node answers', () => {
  const [, path] = /kLivePath = "([^"]*)"/.exec(readFileSync(join(root, 'viz_node/web/request_filter.h'), 'utf8'));
  assert.ok(readFileSync(join(root, 'viz_node/web/page/page.ts'), 'utf8').includes(`\${location.host}${path}\${`));
});
