# Compiles shader programs with the OpenGL ES driver at hand and prints what the driver says of each.
#
# Runs on arm64 below qemu: an interpreter from a package needs no cross compiler. Reads JSON as tests/src/programs.rs
# writes it from the file given. The first line that it prints describes the driver, each other one a program, as JSON;
# on standard error the program's number stands before the compiler's listings.

import ctypes
import json
import sys

EGL, GL = ctypes.CDLL("libEGL.so.1"), ctypes.CDLL("libGLESv2.so.2")
P, I, U = ctypes.c_void_p, ctypes.c_int, ctypes.c_uint
STAGES = {"vert": 0x8B31, "frag": 0x8B30, "comp": 0x91B9}


def function(library, name, result, *arguments):
    pointer = getattr(library, name)
    pointer.restype, pointer.argtypes = result, arguments
    return pointer


def make_context():
    surfaceless, es_api = 0x31DD, 0x30A0
    display = function(EGL, "eglGetPlatformDisplay", P, U, P, P)(surfaceless, None, None)
    if not function(EGL, "eglInitialize", U, P, P, P)(display, None, None):
        sys.exit("eglInitialize failed")
    function(EGL, "eglBindAPI", U, U)(es_api)
    version_3_1_debug = (I * 7)(0x3098, 3, 0x30FB, 1, 0x31B0, 1, 0x3038)
    context = function(EGL, "eglCreateContext", P, P, P, P, P)(display, None, None, version_3_1_debug)
    if not context or not function(EGL, "eglMakeCurrent", U, P, P, P, P)(display, None, None, context):
        sys.exit("no OpenGL ES 3.1 context")


make_context()
get_proc = function(EGL, "eglGetProcAddress", P, ctypes.c_char_p)
message_log = ctypes.CFUNCTYPE(U, U, I, P, P, P, P, P, P)(get_proc(b"glGetDebugMessageLogKHR"))
message_control = ctypes.CFUNCTYPE(None, U, U, U, I, P, ctypes.c_ubyte)(get_proc(b"glDebugMessageControlKHR"))
create_shader = function(GL, "glCreateShader", U, U)
shader_source = function(GL, "glShaderSource", None, U, I, P, P)
create_program = function(GL, "glCreateProgram", U)
attach = function(GL, "glAttachShader", None, U, U)


def messages():
    """What the driver has said since the last call; statistics of compiled shaders are such messages."""
    found = []
    while True:
        text, severity, length = ctypes.create_string_buffer(65536), (U * 1)(), (I * 1)()
        if not message_log(1, len(text), None, None, None, severity, length, text):
            return found
        found.append(text.value.decode(errors="replace").strip())


def finish(kind, name, status_name, action):
    """Compiles or links; whether that went well, and the log."""
    function(GL, action, None, U)(name)
    status, log = I(), ctypes.create_string_buffer(65536)
    function(GL, f"glGet{kind}iv", None, U, U, P)(name, status_name, ctypes.byref(status))
    function(GL, f"glGet{kind}InfoLog", None, U, I, P, P)(name, len(log), None, log)
    return bool(status.value), log.value.decode(errors="replace").strip()


def compile_program(stages):
    program, logs = create_program(), []
    for stage in stages:
        shader = create_shader(STAGES[stage["file"].rsplit(".", 1)[1]])
        text = stage["text"].encode()
        shader_source(shader, 1, (ctypes.c_char_p * 1)(text), (I * 1)(len(text)))
        compiled, log = finish("Shader", shader, 0x8B81, "glCompileShader")
        logs.append(log)
        if not compiled:
            return False, logs
        attach(program, shader)
    linked, log = finish("Program", program, 0x8B82, "glLinkProgram")
    return linked, [*logs, log]


def say(value):
    print(json.dumps(value), flush=True)


function(GL, "glEnable", None, U)(0x92E0)  # GL_DEBUG_OUTPUT_KHR
message_control(0x1100, 0x1100, 0x1100, 0, None, 1)
get_string = function(GL, "glGetString", ctypes.c_char_p, U)
say({"renderer": get_string(0x1F01).decode(), "version": get_string(0x1F02).decode()})
with open(sys.argv[1]) as file:
    programs = json.load(file)
for number, program in enumerate(programs):
    print(f"# program {number}", file=sys.stderr, flush=True)
    messages()
    ok, logs = compile_program(program["stages"])
    say({"ok": ok, "log": "\n".join(log for log in logs if log), "messages": messages()})
