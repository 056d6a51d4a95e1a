// viz_node/web/page/gl_canvas.ts -- a canvas of WebGL 2: shapes of vertices, drawn one after the
// other by programs of the page.

/** Numbers per vertex, or indices of vertices, and whether the graphics card has them. */
export class VertexArray<T extends Float32Array | Uint8Array | Uint32Array = Float32Array> {
  isSent = false;

  constructor(
    public array: T,
    readonly size: number, // numbers per vertex
  ) {}

  /** Other numbers, or those of `array` after a change. */
  set(array: T = this.array): void {
    this.array = array;
    this.isSent = false;
  }
}

export type UniformValue = number | boolean | readonly number[];
/** Values of a program's uniforms, by name. */
export type Uniforms = Record<string, UniformValue>;

export interface Program {
  vertex: string; // GLSL ES 3.00, without its first line; reads modelViewMatrix and projectionMatrix
  fragment: string;
}

/** The fragment shader of what has the colour of its vertices. */
export const COLOUR_FRAGMENT = /* glsl */ `
  precision mediump float;
  in vec3 colour;
  out vec4 pixel;
  void main() { pixel = vec4(colour, 1.0); }
`;

/** Part of a shape: `count` of its indices, or vertices, from `first` on, with uniforms of its own. */
export interface Part {
  first: number;
  count: number;
  uniforms: Uniforms;
}

export interface Shape {
  kind: 'points' | 'lines' | 'triangles';
  program: Program;
  vertices: Record<string, VertexArray<Float32Array> | VertexArray<Uint8Array>>; // bytes are shares of 255
  index: VertexArray<Uint32Array> | null;
  uniforms: Uniforms; // of all parts
  parts: Part[];
  isVisible: boolean;
  writesDepth: boolean; // hides what is drawn behind it later
  isOneSided: boolean; // seen only where its vertices go counterclockwise
  isBehindLines: boolean; // a little farther than it is: its own edges are seen
}

/** The shape of these vertices, as most are drawn. */
export function shapeOf(kind: Shape['kind'], program: Program, vertices: Shape['vertices'], more: Partial<Shape> = {}): Shape {
  return { kind, program, vertices, index: null, uniforms: {}, parts: [], isVisible: true, writesDepth: true, isOneSided: false, isBehindLines: false, ...more };
}

const CONTEXT_EVENTS = ['webglcontextlost', 'webglcontextrestored'];

interface BuiltProgram {
  handle: WebGLProgram;
  uniforms: Map<string, WebGLUniformLocation>;
  inputs: Map<string, number>;
}

export class GlCanvas {
  readonly element = document.createElement('canvas');
  readonly shapes: Shape[] = []; // drawn in this order
  private readonly gl: WebGL2RenderingContext;
  private readonly programs = new Map<Program, BuiltProgram>();
  private readonly buffers = new Map<VertexArray<never>, { handle: WebGLBuffer; bytes: number }>();
  private background: readonly number[] = [0, 0, 0];

  constructor(
    antialias: boolean,
    private readonly pixelRatio: number,
    private readonly contextLost: (lost: boolean) => void, // the browser took the graphics away, or gave them back
  ) {
    const gl = this.element.getContext('webgl2', { alpha: false, antialias, powerPreference: 'high-performance' });
    if (gl === null) throw new Error('the browser gives no WebGL 2');
    this.gl = gl;
    this.element.style.display = 'block';
    for (const event of CONTEXT_EVENTS) this.element.addEventListener(event, this.noteContext);
  }

  private readonly noteContext = (event: Event): void => {
    event.preventDefault(); // without it the browser gives no context again
    this.programs.clear();
    this.buffers.clear();
    this.contextLost(event.type === 'webglcontextlost');
  };

  /** @param colour  red, green and blue, 0..1 */
  clearTo(colour: readonly number[]): void {
    this.background = colour;
  }

  /** @param width, height  [CSS pixels] */
  resize(width: number, height: number): void {
    this.element.width = Math.floor(width * this.pixelRatio);
    this.element.height = Math.floor(height * this.pixelRatio);
    Object.assign(this.element.style, { width: `${width}px`, height: `${height}px` });
  }

  /** Draws all shapes, seen through these matrices of 16 numbers. */
  draw(modelViewMatrix: number[], projectionMatrix: number[]): void {
    const { gl } = this;
    if (gl.isContextLost()) return;
    const matrices = { modelViewMatrix, projectionMatrix };
    gl.viewport(0, 0, this.element.width, this.element.height);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    const [red, green, blue] = this.background as [number, number, number];
    gl.clearColor(red, green, blue, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    for (const shape of this.shapes) if (shape.isVisible) this.drawShape(shape, matrices);
  }

  /** Red, green and blue, 0..255, of a pixel as it was drawn last in this task; `x`, `y` [CSS pixels] from the lower left. */
  pixelAt(x: number, y: number): number[] {
    const { gl } = this;
    const colour = new Uint8Array(4);
    gl.readPixels(Math.floor(x * this.pixelRatio), Math.floor(y * this.pixelRatio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
    return [...colour.slice(0, 3)];
  }

  /** Gives the graphics back to the browser. */
  dispose(): void {
    for (const event of CONTEXT_EVENTS) this.element.removeEventListener(event, this.noteContext);
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
    this.element.remove();
  }

  private drawShape(shape: Shape, matrices: Uniforms): void {
    const { gl } = this;
    const program = this.built(shape.program);
    gl.useProgram(program.handle);
    this.setUniforms(program, matrices);
    this.setUniforms(program, shape.uniforms);
    gl.depthMask(shape.writesDepth);
    this.switch(gl.CULL_FACE, shape.isOneSided);
    this.switch(gl.POLYGON_OFFSET_FILL, shape.isBehindLines);
    gl.polygonOffset(1, 1);
    for (const [name, place] of program.inputs) this.feed(place, shape.vertices[name]);
    if (shape.index !== null) this.send(gl.ELEMENT_ARRAY_BUFFER, shape.index);
    const mode = { points: gl.POINTS, lines: gl.LINES, triangles: gl.TRIANGLES }[shape.kind];
    for (const { first, count, uniforms } of shape.parts) {
      this.setUniforms(program, uniforms);
      if (shape.index === null) gl.drawArrays(mode, first, count);
      else gl.drawElements(mode, count, gl.UNSIGNED_INT, first * Uint32Array.BYTES_PER_ELEMENT);
    }
    for (const place of program.inputs.values()) gl.disableVertexAttribArray(place);
  }

  private switch(what: number, on: boolean): void {
    if (on) this.gl.enable(what);
    else this.gl.disable(what);
  }

  private feed(place: number, vertices: Shape['vertices'][string] | undefined): void {
    if (vertices === undefined) throw new Error('a shape lacks vertices that its program reads');
    const { gl } = this;
    this.send(gl.ARRAY_BUFFER, vertices);
    const isBytes = vertices.array instanceof Uint8Array;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, vertices.size, isBytes ? gl.UNSIGNED_BYTE : gl.FLOAT, isBytes, 0, 0);
  }

  /** Binds the buffer of an array, with its newest numbers in it. */
  private send(target: number, array: VertexArray<Float32Array> | VertexArray<Uint8Array> | VertexArray<Uint32Array>): void {
    const { gl } = this;
    const known = this.buffers.get(array as VertexArray<never>);
    const buffer = known ?? { handle: gl.createBuffer(), bytes: -1 };
    gl.bindBuffer(target, buffer.handle);
    if (known !== undefined && array.isSent) return;
    const { byteLength } = array.array;
    if (buffer.bytes === byteLength) gl.bufferSubData(target, 0, array.array);
    else gl.bufferData(target, array.array, gl.DYNAMIC_DRAW);
    this.buffers.set(array as VertexArray<never>, { handle: buffer.handle, bytes: byteLength });
    array.isSent = true;
  }

  private setUniforms({ uniforms }: BuiltProgram, values: Uniforms): void {
    const { gl } = this;
    for (const [name, value] of Object.entries(values)) {
      const place = uniforms.get(name);
      if (place === undefined) continue;
      if (typeof value === 'boolean') gl.uniform1i(place, Number(value));
      else if (typeof value === 'number') gl.uniform1f(place, value);
      else if (value.length === 3) gl.uniform3fv(place, value);
      else if (value.length === 4) gl.uniform4fv(place, value);
      else gl.uniformMatrix4fv(place, false, value);
    }
  }

  private built(program: Program): BuiltProgram {
    const known = this.programs.get(program);
    if (known !== undefined) return known;
    const { gl } = this;
    const handle = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, program.vertex], [gl.FRAGMENT_SHADER, program.fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, `#version 300 es\n${text}`);
      gl.compileShader(shader);
      gl.attachShader(handle, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(`shader: ${gl.getShaderInfoLog(shader)}`);
      gl.deleteShader(shader); // as soon as the program is
    }
    gl.linkProgram(handle);
    if (!gl.getProgramParameter(handle, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(`program: ${gl.getProgramInfoLog(handle)}`);
    const built: BuiltProgram = { handle, uniforms: new Map(), inputs: new Map() };
    const count = (what: number) => Number(gl.getProgramParameter(handle, what) ?? 0);
    for (let i = 0; i < count(gl.ACTIVE_UNIFORMS); ++i) {
      const { name } = gl.getActiveUniform(handle, i)!;
      built.uniforms.set(name, gl.getUniformLocation(handle, name)!);
    }
    for (let i = 0; i < count(gl.ACTIVE_ATTRIBUTES); ++i) {
      const { name } = gl.getActiveAttrib(handle, i)!;
      const place = gl.getAttribLocation(handle, name);
      if (place >= 0) built.inputs.set(name, place); // gl_VertexID has none
    }
    this.programs.set(program, built);
    return built;
  }
}
