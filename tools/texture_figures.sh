#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# The figures of docs/textures.md: a sphere and a wall of each texture, and of what else that page tells. texture_figures.sh CAPLET [SAMPLES]
set -eu
caplet=$1 samples=${2:-64} pictures=textures
. "$(dirname "$0")/figures.sh"

printf 'P3 2 2 255\n180 128 220 128 180 220 128 76 220 76 128 220\n' > "$folder/bends.ppm"

# figure NAME TEXTURES MATERIAL SHAPE KIND: statements before the material, its parameters, those of the shapes, and what it is (diffuse)
figure() {
  rendered "$1" <<END
LookAt 0 -6 1.6  0 0 0.9  0 0 1
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 192 "integer yresolution" 128
Sampler "zsobol" "integer pixelsamples" $samples
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.5 0.5]
LightSource "distant" "point3 from" [-2 -3 4] "point3 to" [0 0 0] "rgb L" [2 2 2]
Material "diffuse" "rgb reflectance" [0.4 0.4 0.4]
Shape "disk" "float radius" 20
$2
Material "${5:-diffuse}" $3
Shape "bilinearmesh" "point3 P" [-0.1 1 0  2.1 1 0  -0.1 1 2  2.1 1 2] $4
Translate -1 0 0.9
Shape "sphere" "float radius" 0.9 $4
END
}

spectrum() { figure "$1" "$2" '"texture reflectance" "t"' ''; }
float() { figure "$1" "$2 Texture \"c\" \"spectrum\" \"mix\" \"rgb tex1\" [0.1 0.2 0.4] \"rgb tex2\" [0.9 0.8 0.6] \"texture amount\" \"t\"" '"texture reflectance" "c"' ''; }

colors='"rgb tex1" [0.8 0.5 0.1] "rgb tex2" [0.1 0.2 0.5]'
spectrum constant 'Texture "t" "spectrum" "constant" "rgb value" [0.8 0.5 0.1]'
spectrum imagemap 'Texture "t" "spectrum" "imagemap" "string filename" "tiles.ppm" "string filter" "point" "float uscale" 2'
spectrum checkerboard "Texture \"t\" \"spectrum\" \"checkerboard\" $colors \"float uscale\" 8 \"float vscale\" 8"
spectrum bilerp 'Texture "t" "spectrum" "bilerp" "rgb v00" [0.8 0.1 0.1] "rgb v01" [0.1 0.8 0.1] "rgb v10" [0.1 0.1 0.8] "rgb v11" [0.8 0.8 0.1]'
spectrum dots 'Texture "t" "spectrum" "dots" "rgb inside" [0.8 0.5 0.1] "rgb outside" [0.1 0.2 0.5] "float uscale" 8 "float vscale" 8'
float fbm 'Scale 0.4 0.4 0.4 Texture "n" "float" "fbm" Texture "t" "float" "mix" "float tex1" 0.5 "float tex2" 1.5 "texture amount" "n" Scale 2.5 2.5 2.5'
float wrinkled 'Scale 0.4 0.4 0.4 Texture "t" "float" "wrinkled" Scale 2.5 2.5 2.5'
float windy 'Scale 0.1 0.1 0.1 Texture "n" "float" "windy" Texture "t" "float" "mix" "float tex1" 0.5 "float tex2" 2.5 "texture amount" "n" Scale 10 10 10'
spectrum marble 'Texture "t" "spectrum" "marble" "float scale" 5 "float variation" 1'
spectrum directionmix "Texture \"t\" \"spectrum\" \"directionmix\" $colors \"vector3 dir\" [0 0 1]"
spectrum scale 'Texture "a" "float" "checkerboard" "float tex1" 1 "float tex2" 0.3 "float uscale" 8 "float vscale" 8 Texture "m" "spectrum" "imagemap" "string filename" "tiles.ppm" Texture "t" "spectrum" "scale" "texture tex" "m" "texture scale" "a"'
spectrum mix 'Texture "a" "float" "wrinkled" Texture "m" "spectrum" "imagemap" "string filename" "tiles.ppm" Texture "t" "spectrum" "mix" "texture tex1" "m" "rgb tex2" [1 1 1] "texture amount" "a"'
float root 'Texture "n" "float" "bilerp" "float v01" 0 "float v10" 1 "float v11" 1 Texture "t" "float" "root" "texture tex" "n"'
figure extinction 'Texture "t" "spectrum" "imagemap" "string filename" "tiles.ppm" "string filter" "point" "float uscale" 2' \
  '"texture reflectance" "t" "float roughness" 0.3' '' conductor
figure normalmap '' '"string normalmap" "bends.ppm"' ''
figure displacement 'Scale 0.2 0.2 0.2 Texture "n" "float" "fbm" Scale 5 5 5 Texture "t" "float" "scale" "texture tex" "n" "float scale" 0.05' '"texture displacement" "t"' ''
figure alpha 'Texture "t" "float" "dots" "float uscale" 8 "float vscale" 8' '"rgb reflectance" [0.8 0.5 0.1]' '"texture alpha" "t"'
