#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Meshes that make their reader crash, hang or eat the machine: each ends with status 1, one line,
# bounded memory, no core and no process left; and side files lie where they may.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

python3 - <<'PY'
import base64, json, math, os, struct

def write(name, data):
    with open(name, 'wb' if isinstance(data, bytes) else 'w') as f:
        f.write(data)

points = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0)

def gltf(nodes, uri='data:application/octet-stream;base64,' + base64.b64encode(points).decode()):
    return json.dumps({
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': nodes,
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3',
                       'min': [0, 0, 0], 'max': [1, 1, 0]}],
        'bufferViews': [{'buffer': 0, 'byteLength': 36}],
        'buffers': [{'byteLength': 36, 'uri': uri}]})

def collada(library='', scene='<node id="n"><instance_geometry url="#g"/></node>', count='1',
            p='0 1 2', floats='9', points='3'):
    return f'''<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="m" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{floats}">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="{points}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{count}"><input semantic="VERTEX" source="#v" offset="0"/><p>{p}</p></triangles>
</mesh></geometry></library_geometries><library_nodes>{library}</library_nodes>
<library_visual_scenes><visual_scene id="s">{scene}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>'''

def glb(chunk, length=None):
    length = len(chunk) if length is None else length
    return b'glTF' + struct.pack('<III', 2, 20 + len(chunk), length) + b'JSON' + chunk

obj = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'
leaf = '<instance_geometry url="#g"/>'
for folder in ('bad', 'good', 'good/deep', 'outside'):
    os.mkdir(folder)

write('bad/count_0.dae', collada(count='0'))
write('bad/no_floats.dae', collada(floats='0'))
write('bad/no_points.dae', collada(points='0'))
write('bad/huge_count.dae', collada(count='4000000000', floats='4000000000', points='4000000000'))
write('bad/p_x.dae', collada(p='x '))
write('bad/itself.dae', collada('<node id="a">' + leaf + '<instance_node url="#a"/></node>',
                                '<node><instance_node url="#a"/></node>'))
write('bad/circle.dae', collada('<node id="a"><instance_node url="#b"/></node>'
                                '<node id="b"><instance_node url="#a"/></node>',
                                '<node><instance_node url="#a"/></node>'))
# Instances that look like circles: in comments, and in a name.
write('good/comment.dae', collada('<!-- <node id="a"> --><node id="b"><!-- <instance_node url="#b"/>'
                                  '--></node><node id="a">' + leaf + '</node>',
                                  '<node name=\'a > b\' id = "c"><instance_node url="#a"/>'
                                  '<node/></node>'))
write('bad/nested.dae', collada(scene='<node>' * 30000 + leaf + '</node>' * 30000))
write('bad/twice.dae', collada(
    ''.join(f'<node id="a{i}"><instance_node url="#a{i + 1}"/><instance_node url="#a{i + 1}"/></node>'
            for i in range(31)) + '<node id="a31">' + leaf + '</node>',
    '<node><instance_node url="#a0"/></node>'))
# Assimp looks for nodes by their names, too.
write('bad/named_itself.dae', collada('<node name="a"><instance_node url="#a"/></node>',
                                      '<node><instance_node url="#a"/></node>'))
# A byte that is no UTF-8, and capitals, make no check blind.
twice = gltf([{'children': [i + 1, i + 1]} for i in range(31)] + [{'mesh': 0}])
write('bad/twice_latin.gltf', b'{"x": "\xff", ' + twice[1:].encode())
write('good/latin.gltf', b'{"x": "\xff", ' + gltf([{'mesh': 0}])[1:].encode())
write('bad/capitals.ply', 'PLY\nformat ascii 1.0\nelement vertex 3\nproperty float x')
write('bad/nested_json.gltf', '[' * 300000)
write('bad/lists_of_accessors.gltf', '{"asset":{"version":"2.0"},"meshes":[{"componentType":1}],"accessors":[[5]]}')
write('bad/nested_extras.gltf', gltf([{'mesh': 0}])[:-1] + ', "extras": ' + '[' * 300000 +
      ']' * 300000 + '}')
write('bad/nested_nodes.gltf', gltf([{'children': [i + 1]} for i in range(200000)] + [{'mesh': 0}]))
write('bad/twice.gltf', gltf([{'children': [i + 1, i + 1]} for i in range(31)] + [{'mesh': 0}]))
write('bad/itself.gltf', gltf([{'mesh': 0, 'children': [0]}]))
write('bad/many_nodes.gltf', gltf([{'children': list(range(1, 1001))}] + [{'children': [1001] * 1001}]
                                  * 1000 + [{'mesh': 0}]))
write('bad/no_buffer.gltf', gltf([{'mesh': 0}], 'missing.bin'))
write('bad/chunk.glb', glb(gltf([{'mesh': 0}]).encode() + b' ' * 40, 0xfffffffc))
write('bad/chunk_deep.glb', glb(b'{"a":' * 300000))
write('bad/short.glb', b'glTF' + struct.pack('<II', 2, 12))
write('bad/huge.ply', 'ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n')
write('bad/cut.ply', 'ply\nformat ascii 1.0\n')
write('bad/csm.obj', '; csm\n$Firstframe 0\n$Lastframe 10\n$Spinaxis 0\n$Points\n$Order\na b\n')
write('bad/csm.csm', '; csm\n$Firstframe 0\n$Lastframe 10\n$Points\n0 0 0\n$Order\na b\n')
write('bad/ase.ase', '*3DSMAX_ASCIIEXPORT 200\n*SCENE {\n')
write('bad/x.x', 'xof 0303txt 0032\nMesh { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; 3;0,1,2;; }\n')
write('bad/off.off', 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n')
write('bad/kaydara.fbx', b'Kaydara FBX Binary  \0\x1a\0' + b'\0' * 100)
write('bad/bin.assbin', b'ASSIMP.binary-dump.' + b'\0' * 600)
write('bad/magic.obj', 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n')
write('bad/empty.stl', '')
# A comb with corners that take a minute to compare with each other.
n = 15000
comb = [(i, i % 2 * 5) for i in range(n)] + [(n - 1 - i, (i + 1) % 2 * 5 - 10) for i in range(n)]
write('slow.obj', ''.join(f'v {x} {y} 0\n' for x, y in comb) +
      ('f ' + ' '.join(str(i + 1) for i in range(2 * n)) + '\n') * 20)
os.mkfifo('bad/fifo')
write('bad/mtl_fifo.obj', 'mtllib fifo\n' + obj)
write('bad/uri_fifo.gltf', gltf([{'mesh': 0}], 'fifo'))
write('bad/uri_device.gltf', gltf([{'mesh': 0}], '../../../../../../../../../../../../dev/zero'))
write('bad/uri_absolute.gltf', gltf([{'mesh': 0}], '/etc/passwd'))
write('bad/uri_folder.gltf', gltf([{'mesh': 0}], '.'))
write('outside/points.bin', points)
write('outside/chair.mtl', 'newmtl red\n')
write('bad/uri_up.gltf', gltf([{'mesh': 0}], '../outside/points.bin'))
write('bad/mtl_up.obj', 'mtllib ../outside/chair.mtl\n' + obj)
os.symlink('../outside/points.bin', 'bad/link.bin')
write('bad/uri_link.gltf', gltf([{'mesh': 0}], 'link.bin'))

write('good/deep/points.bin', points)
write('good/uri.gltf', gltf([{'mesh': 0}], 'deep/points.bin'))
write('good/chair.mtl', 'newmtl red\n')
write('good/chair.obj', 'mtllib chair.mtl\nusemtl red\n' + obj)
write('good/no_materials.obj', 'mtllib /home/somebody/else.mtl\nusemtl red\n' + obj)
write('good/deep.dae', collada(scene='<node>' * 900 + leaf + '</node>' * 900))
write('good/twice.dae', collada('<node id="a">' + leaf + '</node>', '<node id="b" name="a">'
                                '<instance_node url="#a"/><instance_node url="#a"/></node>'))
PY

# envc as ever, but one that hangs is ended, or leaves a process behind, and its memory, with that of
# its children, is in ./used (MB).
cat >run.py <<'PY'
import ctypes, os, resource, subprocess, sys
PR_SET_CHILD_SUBREAPER = 36
ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
try:
    status = subprocess.run(sys.argv[1:], timeout=120).returncode
except subprocess.TimeoutExpired:
    status = 98
open('used', 'w').write(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024))
try:
    os.waitpid(-1, os.WNOHANG)
    status = 97
except ChildProcessError:
    pass
sys.exit(status)
PY
envc() { python3 run.py "$binary_dir/bin/envc" "$@"; }

ulimit -c unlimited
sanitized=no
grep -q '^ISPACE_SANITIZE:[A-Z]*=ON' "$binary_dir/CMakeCache.txt" && sanitized=yes
for file in bad/*.*; do
    case $file in *.bin) continue ;; esac
    printf '#env 1\nispace size=4,3\nmesh at=1,1 file=%s\n' "$file" >room.env
    expect_error 1 envc room.env -o room.glb
    grep -q '^envc: room.env:3:[0-9]*: error: mesh file `'"$file" err || fail "$file: $(cat err)"
    [ ! -e room.glb ] || fail "$file: a product"
    [ $sanitized = yes ] || [ "$(cat used)" -lt 1500 ] || fail "$file: $(cat used) MB"
    echo "$file: $(cat used) MB: $(sed 's/.*error: //' err)"
done | tee hostile.log
[ -z "$(find . -name 'core*')" ] || fail "a core is left"

expect_message() { # FILE TEXT
    grep "^$1: " hostile.log | has -F -- "$2" || fail "$1: $(grep "^$1: " hostile.log)"
}
expect_message bad/itself.dae 'a node that contains itself'
expect_message bad/itself.gltf 'a node that contains itself'
expect_message bad/named_itself.dae 'a node that contains itself'
expect_message bad/twice_latin.gltf 'more than 1000000 nodes'
expect_message bad/capitals.ply 'without `end_header`'
expect_message bad/nested.dae 'nodes nested more than 1000 deep'
expect_message bad/nested_nodes.gltf 'nodes nested more than 1000 deep'
expect_message bad/twice.gltf 'more than 1000000 nodes'
expect_message bad/twice.dae 'more than 1000000 nodes'
expect_message bad/many_nodes.gltf 'more than 1000000 nodes'
expect_message bad/nested_json.gltf 'JSON nested more than 500 deep'
expect_message bad/chunk_deep.glb 'JSON nested more than 500 deep'
expect_message bad/chunk.glb 'JSON of 4294967292 bytes in'
expect_message bad/lists_of_accessors.gltf 'it cannot be read as gltf'
if [ $sanitized = no ]; then
    expect_message bad/p_x.dae 'it takes more than 1 GB of memory'
    # Refused by assimp 5.4.
    grep '^bad/no_floats.dae: ' hostile.log |
        has -E 'assimp crashes on it \(Segmentation fault\)|assimp says: Not enough data for accessor' ||
        fail "bad/no_floats.dae: $(grep '^bad/no_floats.dae: ' hostile.log)"
fi
expect_message bad/off.off 'assimp export FILE off.obj'
expect_message bad/mtl_fifo.obj 'is no regular file'
expect_message bad/uri_fifo.gltf 'is no regular file'
for file in uri_up.gltf uri_link.gltf uri_absolute.gltf mtl_up.obj; do
    expect_message "bad/$file" 'outside its folder'
    expect_message "bad/$file" 'side_files=anywhere'
done

# Side files that are fine are named for make, and only those that are there.
for file in good/*.*; do
    case $file in *.mtl) continue ;; esac
    printf '#env 1\nispace size=4,3\nmesh at=1,1 file=%s\n' "$file" >room.env
    expect_status 0 envc room.env -o room.glb -MD
    cp room.glb.d "${file##*/}.d"
done
grep -q 'good/uri.gltf good/deep/points.bin' <(tr -d '\\\n' <uri.gltf.d | tr -s ' ') ||
    fail "no buffer in: $(cat uri.gltf.d)"
grep -q 'good/chair.mtl' chair.obj.d || fail "no materials in: $(cat chair.obj.d)"
if grep 'else.mtl' no_materials.obj.d; then fail "materials that are not there"; fi

# The room allows files elsewhere, but its digest stays the same.
envc - --info >in_folder <<<$'#env 1\nispace size=4,3\nmesh at=1,1 file=good/uri.gltf'
printf '#env 1\nispace size=4,3\nmesh at=1,1 file=bad/uri_up.gltf side_files=anywhere\n' >room.env
expect_status 0 envc room.env -o room.glb -MD
grep -q 'outside/points.bin' room.glb.d || fail "no buffer in: $(cat room.glb.d)"
envc room.env --info >anywhere
expect_same <(grep ^digest in_folder) <(grep ^digest anywhere) "another digest"
printf '#env 1\nispace size=4,3\nmesh at=1,1 file=bad/uri_fifo.gltf side_files=anywhere\n' >room.env
expect_error 1 envc room.env -o room.glb

# As an operand, too.
expect_error 1 envc bad/off.off
grep -q 'a .off mesh: convert it' err || fail "$(cat err)"
expect_error 1 envc bad/p_x.dae --slice-walls 0.5

# One that takes longer than it may ends by itself.
python3 - "$binary_dir/lib/ispace/read-mesh" <<'PY'
import os, signal, socket, subprocess, sys
ours, theirs = socket.socketpair()
size = os.path.getsize('slow.obj')
with open('slow.obj') as mesh:
    reader = subprocess.Popen([sys.argv[1], '.obj', 'auto', str(os.getpid()), str(size),
                               str(1 << 30), '1', '1000000', '0'], stdin=mesh, stdout=theirs)
status = reader.wait(timeout=100)
assert status == -signal.SIGXCPU, status
PY

# The mesh reader ends with its parent.
"$binary_dir/bin/envc" slow.obj --check >out 2>err &
envc=$!
for _ in $(seq 100); do
    reader=$(pgrep -P $envc -x read-mesh) && break
    sleep 0.05
done
[ -n "$reader" ] || fail "nothing reads slow.obj: $(cat err)"
sleep 0.5
kill -0 "$reader" || fail "slow.obj is not slow: $(cat err)"
kill -KILL $envc
wait $envc 2>/dev/null || true
is_gone() { [ ! -d "/proc/$reader" ] || grep -q '^State:.*[ZX] ' "/proc/$reader/status"; }
for _ in $(seq 100); do
    is_gone && break
    sleep 0.05
done
is_gone || fail "left running after its parent"
