"""Compiles HLSL with Microsoft's compiler.

Usage: dxc.py LIBRARY PROFILE ENTRY FILE [NAME=VALUE...]

LIBRARY is libdxcompiler.so, which Python wheels contain. Prints the compiler's messages. The exit code is 0 if the file
compiles without a warning.
"""

import ctypes
import sys
import uuid

library, profile, entry, file, *defines = sys.argv[1:]
arguments = ["-T", profile, "-E", entry, "-WX"] + [part for define in defines for part in ("-D", define)]


class Buffer(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("size", ctypes.c_size_t), ("encoding", ctypes.c_uint)]


def guid(text):
    return (ctypes.c_byte * 16)(*uuid.UUID(text).bytes_le)


def call(instance, slot, *values, result=ctypes.c_int):
    """Calls a method of a COM interface by its place in the table."""
    table = ctypes.cast(instance, ctypes.POINTER(ctypes.POINTER(ctypes.c_void_p))).contents
    method = ctypes.CFUNCTYPE(result, ctypes.c_void_p, *map(type, values))(table[slot])
    return method(instance, *values)


def checked(code):
    if code != 0:
        sys.exit(f"the compiler's interface failed with {code & 0xFFFFFFFF:#x}")


compiler, results, status, errors = (ctypes.c_void_p() for _ in range(4))
create = ctypes.CDLL(library).DxcCreateInstance
# CLSID_DxcCompiler, IDxcCompiler3.
checked(create(guid("73e22d93-e6ce-47f3-b5bf-f0664f39c1b0"), guid("228b4687-5a6a-4730-900c-9702b2203f54"), ctypes.byref(compiler)))

text = open(file, "rb").read()
UTF_8 = 65001
source = Buffer(ctypes.cast(ctypes.c_char_p(text), ctypes.c_void_p), len(text), UTF_8)
words = (ctypes.c_wchar_p * len(arguments))(*arguments)
# IDxcCompiler3::Compile, after the three methods of IUnknown.
checked(call(compiler, 3, ctypes.pointer(source), words, ctypes.c_uint(len(arguments)), ctypes.c_void_p(),
             guid("58346cda-dde7-4497-9461-6f87af5e0659"), ctypes.pointer(results)))
# IDxcOperationResult::GetStatus and ::GetErrorBuffer, IDxcBlob::GetBufferPointer and ::GetBufferSize.
code = ctypes.c_int()
checked(call(results, 3, ctypes.pointer(code)))
checked(call(results, 5, ctypes.pointer(errors)))
size = call(errors, 4, result=ctypes.c_size_t) if errors else 0
if size:
    print(ctypes.string_at(call(errors, 3, result=ctypes.c_void_p), size).decode(errors="replace").rstrip("\0\n "))
sys.exit(1 if code.value else 0)
