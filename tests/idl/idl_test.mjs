// tests/idl/idl_test.mjs -- a parser of another house reads every file of idl/ and finds in it the
// messages and fields that the generated classes have.
//
// usage: node idl_test.mjs IDL_FOLDER GENERATED_FOLDER FOLDER_WITH_NODE_MODULES
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, join } from 'node:path';
import test from 'node:test';

const SKIPPED = 77;
const [idlFolder, generatedFolder, web] = process.argv.slice(2);

let parseIDL;
try {
  ({ parseIDL } = createRequire(join(web, 'package.json'))('@foxglove/omgidl-parser'));
} catch (error) {
  if (error.code !== 'MODULE_NOT_FOUND') throw error;
  console.log(`skipped: @foxglove/omgidl-parser is not installed: run npm ci in ${web}`);
  process.exit(SKIPPED);
}

const NAMESPACE = 'cordis::msg::';
const units = readdirSync(idlFolder).filter((file) => file.endsWith('.idl'));
const parse = (unit) => parseIDL(readFileSync(join(idlFolder, unit), 'utf8'));
const definitions = units.flatMap(parse);
const structs = definitions.filter((definition) => definition.aggregatedKind === 'struct');
/** Constants and values of enums by their names. */
const constants = new Map(
  definitions.filter((d) => d.aggregatedKind === 'module').flatMap((d) => d.definitions.map(({ name, value }) => [name, value])),
);
const enums = definitions.filter((d) => d.aggregatedKind === 'module' && d.name !== NAMESPACE.slice(0, -2));
const own = (definition) => definition.name.slice(NAMESPACE.length);

/** Class name to the names of its members, as fastddsgen understood the file. */
function generatedClasses(unit) {
  const text = readFileSync(join(generatedFolder, `${basename(unit, '.idl')}.h`), 'utf8');
  const classes = new Map();
  for (const [, name, body] of text.matchAll(/^ *class (\w+)\n\s*\{\n(.*?)^ *\};/gms)) {
    classes.set(name, [...body.matchAll(/ m_(\w+)(?: = [^;]*)?;/g)].map(([, member]) => member));
  }
  return classes;
}

test('the messages are those of the contract', () => {
  const contract = {
    'control.idl': ['CommandAuthenticator', 'ControlCommand', 'ControlReply', 'LiaisonChanges', 'NodeStatus'],
    'gesture.idl': ['GesturePositions', 'GestureForces', 'DeviceDescription', 'PointerTarget', 'PointerState'],
    'inputs.idl': ['SourceFile', 'InputScene', 'InputSample', 'InputReach', 'InputEvent', 'SceneInputs'],
    'scene.idl': [
      'NamedRange', 'PortDescription', 'PortFrame', 'SignalDescription', 'StateMachineDescription', 'SetDescription', 'SurfaceDescription',
      'ColouredRange', 'SceneDescription', 'SceneFrame', 'SceneSignals', 'SceneSound', 'LinkEvent', 'SceneEvents',
    ],
    'topics.idl': [],
  };
  assert.deepEqual([...units].sort(), Object.keys(contract));
  for (const unit of units) assert.deepEqual(parse(unit).filter((d) => d.aggregatedKind === 'struct').map(own), contract[unit]);
});

for (const unit of units) {
  test(`both parsers find the same fields in ${unit}`, () => {
    const read = parse(unit).filter((definition) => definition.aggregatedKind === 'struct');
    const wanted = new Map(read.map((definition) => [own(definition), definition.definitions.map((field) => field.name)]));
    assert.deepEqual(generatedClasses(unit), wanted);
  });
}

test('both parsers find the same values of enums', () => {
  assert.deepEqual(enums.map(own).sort(), [
    'ControlVerb', 'EventQuantity', 'InputClock', 'InputKind', 'MatKind', 'NodeKind', 'NodePhase', 'PortRole', 'ReachBound',
    'SceneBound', 'SignalRate', 'SurfaceKind',
  ]);
  const generated = units.map((unit) => readFileSync(join(generatedFolder, `${basename(unit, '.idl')}.h`), 'utf8')).join('\n');
  for (const definition of enums) {
    const [, body] = generated.match(new RegExp(`enum ${own(definition)} : uint32_t\\s*\\{([^}]*)\\}`));
    assert.deepEqual(body.split(',').map((name) => name.trim()), definition.definitions.map(({ name }) => name));
  }
});

test('the version of the wire stands at the place where every version has it', () => {
  assert.ok(constants.get('WIRE_VERSION') >= 1);
  const placeOf = (name) =>
    structs.find((definition) => own(definition) === name).definitions.findIndex((field) => field.name === 'wire_version');
  assert.deepEqual(['DeviceDescription', 'NodeStatus', 'SceneDescription', 'SceneInputs'].map(placeOf), [1, 1, 0, 2]);
});

test('the page has the numbers of the contract', () => {
  const text = readFileSync(join(web, 'page/wire.ts'), 'utf8');
  const numbers = [...text.matchAll(/^export const (\w+) = (\d+);$/gm)];
  assert.ok(numbers.length > 0);
  for (const [, name, value] of numbers) assert.equal(Number(value), constants.get(name), name);
});

test('the generator keeps its temporary files in the build tree', () => {
  for (const unit of units) assert.ok(existsSync(join(generatedFolder, '../../idl/fastddsgen', `${unit}.cc`)), unit);
});

test('every message is final, in the namespace, and of complete types', () => {
  const known = new Set([...structs, ...enums].map((definition) => definition.name));
  for (const definition of structs) {
    assert.ok(definition.name.startsWith(NAMESPACE), definition.name);
    assert.ok(definition.annotations?.final, `${definition.name} is not @final`);
    for (const field of definition.definitions) {
      assert.ok(!field.isComplex || known.has(field.type), `${definition.name}.${field.name} is of unknown type ${field.type}`);
    }
  }
});

test('messages of the force loop have a fixed size and 16 axes', () => {
  assert.equal(constants.get('MAX_AXES'), 16);
  for (const [name, perAxis] of [['GesturePositions', 'position_m'], ['GestureForces', 'force_n']]) {
    const fields = structs.find((definition) => own(definition) === name).definitions;
    for (const field of fields) {
      assert.notEqual(field.type, 'string', field.name);
      assert.ok(!field.isArray || field.arrayLengths, `${name}.${field.name} is a sequence`);
    }
    assert.deepEqual(fields.find((field) => field.name === perAxis)?.arrayLengths, [16]);
    assert.deepEqual(fields.filter((field) => field.annotations?.key).map((field) => field.name), ['device_id']);
  }
});

test('the table of topics names every message that is sent by itself, and no other', () => {
  const rows = readFileSync(join(idlFolder, 'README.md'), 'utf8').matchAll(/^\| `([a-z/]+)` \| `(\w+)` \|/gm);
  const nested = new Set(structs.flatMap((definition) => definition.definitions.map((field) => field.type)));
  const sent = structs.filter((definition) => !nested.has(definition.name)).map(own);
  const table = [...rows];
  assert.deepEqual(table.map(([, , type]) => type).sort(), sent.sort());
  const topics = [...constants].filter(([name]) => name.startsWith('TOPIC_')).map(([, value]) => value);
  assert.deepEqual(table.map(([, topic]) => topic), topics);
});
