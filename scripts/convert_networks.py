#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Converts the two face networks from TensorFlow Lite to ONNX, for OpenCV's dnn module.

    convert_networks.py --assets PACKED.data --loader PACKED_loader.js --out FOLDER

face_detection.onnx
    input     1x3x128x128  RGB, -1..1
    boxes     896x16       per anchor: box centre and size, then six keypoints (right eye, left eye,
                           nose tip, mouth, right ear, left ear), as x, y in pixels of the input;
                           centre and keypoints relative to the anchor's centre
    scores    896x1        logits (sigmoid gives the probability)
    Anchors, in this order: a 16x16 grid (stride 8), 2 a cell, then an 8x8 grid (stride 16), 6 a cell;
    rows first; centres in the middle of the cells; the anchors' size does not enter.
face_landmark.onnx
    input      1x3x192x192  RGB, 0..1
    landmarks  1x1404       468 points x, y, z in pixels of the input; z in the same unit, toward
                            the camera negative
    face_flag  1x1          logit: is there a face

The graphs are computed in NCHW where TensorFlow Lite has NHWC; weights become float32.
"""

import argparse
import os
import re
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from tflite_reader import FormatError, read_model

OPSET = 11
IR_VERSION = 6  # of the same age as the opset: old importers check it

# file in the package -> (file of ours, names of the outputs in the package's order)
NETWORKS = {
    "face_detection_short_range.tflite": ("face_detection.onnx", ["boxes", "scores"]),
    "face_landmark.tflite": ("face_landmark.onnx", ["landmarks", "face_flag"]),
}

# shape of each output, without a spatial layout
OUTPUT_SHAPES = {
    "boxes": [896, 16],
    "scores": [896, 1],
    "landmarks": [1, 1404],
    "face_flag": [1, 1],
}


class Converter:
    """Builds the ONNX graph of one model; tensors are named by number."""

    def __init__(self, model, output_names):
        self.model = model
        self.nodes = []
        self.constants = []
        self.output_names = output_names
        self.flat = set()  # tensors that already have TensorFlow Lite's layout

    def constant(self, name, array):
        self.constants.append(numpy_helper.from_array(np.ascontiguousarray(array), name))
        return name

    def node(self, kind, inputs, outputs, **attributes):
        self.nodes.append(helper.make_node(kind, inputs, outputs, **attributes))

    def name(self, number):
        return "input" if number == self.model.inputs[0] else f"t{number}"

    def weights(self, number):
        tensor = self.model.tensors[number]
        if tensor.constant is None:
            raise FormatError(f"{tensor.name}: computed, want a constant")
        return tensor.constant

    def convert(self):
        for operator in self.model.operators:
            if operator.options.get("activation", 0) != 0:
                raise FormatError(f"{operator.kind}: a fused activation is not supported")
            getattr(self, "on_" + operator.kind.lower())(operator)
        for number, name in zip(self.model.outputs, self.output_names):
            source = f"t{number}" if number in self.flat else self.to_nhwc(number)
            shape = self.constant(name + "_shape", np.array(OUTPUT_SHAPES[name], np.int64))
            self.node("Reshape", [source, shape], [name])

        number = self.model.inputs[0]
        n, h, w, c = self.model.tensors[number].shape
        graph = helper.make_graph(
            self.nodes, "face",
            [helper.make_tensor_value_info("input", TensorProto.FLOAT, [n, c, h, w])],
            [helper.make_tensor_value_info(name, TensorProto.FLOAT, OUTPUT_SHAPES[name])
             for name in self.output_names],
            self.constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)],
                                  producer_name="lorgnette")
        model.ir_version = IR_VERSION
        onnx.checker.check_model(model)
        return model

    def to_nhwc(self, number):
        name = f"t{number}_nhwc"
        self.node("Transpose", [self.name(number)], [name], perm=[0, 2, 3, 1])
        return name

    def pads(self, operator, kernel):
        """[top, left, bottom, right]; SAME puts the odd pixel at the bottom right."""
        if operator.options["padding"] == 1:  # VALID
            return [0, 0, 0, 0]
        before, after = [], []
        in_shape = self.model.tensors[operator.inputs[0]].shape
        out_shape = self.model.tensors[operator.outputs[0]].shape
        for axis, stride in ((0, "stride_h"), (1, "stride_w")):
            needed = (out_shape[1 + axis] - 1) * operator.options[stride] + kernel[axis]
            total = max(needed - in_shape[1 + axis], 0)
            before.append(total // 2)
            after.append(total - total // 2)
        return before + after

    def convolution(self, operator, weights, group):
        if operator.options["dilation_w"] != 1 or operator.options["dilation_h"] != 1:
            raise FormatError("a dilated convolution is not supported")
        x, w, b = operator.inputs
        kernel = list(weights.shape[2:])
        self.node("Conv", [self.name(x), self.constant(f"t{w}", weights),
                           self.constant(f"t{b}", self.weights(b))], [f"t{operator.outputs[0]}"],
                  kernel_shape=kernel, pads=self.pads(operator, kernel), group=group,
                  strides=[operator.options["stride_h"], operator.options["stride_w"]])

    def on_conv_2d(self, operator):  # weights: out, h, w, in
        self.convolution(operator, self.weights(operator.inputs[1]).transpose(0, 3, 1, 2), 1)

    def on_depthwise_conv_2d(self, operator):  # weights: 1, h, w, channels
        if operator.options["depth_multiplier"] != 1:
            raise FormatError("a depth multiplier is not supported")
        weights = self.weights(operator.inputs[1]).transpose(3, 0, 1, 2)
        self.convolution(operator, weights, weights.shape[0])

    def on_prelu(self, operator):  # slopes: 1, 1, channels
        x, slope = operator.inputs
        slopes = self.weights(slope).reshape(-1, 1, 1)
        self.node("PRelu", [self.name(x), self.constant(f"t{slope}", slopes)],
                  [f"t{operator.outputs[0]}"])

    def on_relu(self, operator):
        self.node("Relu", [self.name(operator.inputs[0])], [f"t{operator.outputs[0]}"])

    def on_add(self, operator):
        self.node("Add", [self.name(i) for i in operator.inputs], [f"t{operator.outputs[0]}"])

    def on_max_pool_2d(self, operator):
        kernel = [operator.options["filter_h"], operator.options["filter_w"]]
        self.node("MaxPool", [self.name(operator.inputs[0])], [f"t{operator.outputs[0]}"],
                  kernel_shape=kernel, pads=self.pads(operator, kernel),
                  strides=[operator.options["stride_h"], operator.options["stride_w"]])

    def on_pad(self, operator):  # paddings: 4 x (before, after) in NHWC; zeros
        x, paddings = operator.inputs
        n, h, w, c = self.weights(paddings).tolist()
        pads = [n[0], c[0], h[0], w[0], n[1], c[1], h[1], w[1]]
        name = self.constant(f"t{paddings}", np.array(pads, np.int64))
        self.node("Pad", [self.name(x), name], [f"t{operator.outputs[0]}"], mode="constant")

    def on_reshape(self, operator):
        out = operator.outputs[0]
        shape = self.constant(f"t{out}_shape",
                              np.array(self.model.tensors[out].shape, np.int64))
        self.node("Reshape", [self.to_nhwc(operator.inputs[0]), shape], [f"t{out}"])
        self.flat.add(out)

    def on_concatenation(self, operator):
        if not self.flat.issuperset(operator.inputs):
            raise FormatError("a concatenation of images is not supported")
        self.node("Concat", [self.name(i) for i in operator.inputs], [f"t{operator.outputs[0]}"],
                  axis=operator.options["axis"])
        self.flat.add(operator.outputs[0])


def packed_files(loader_text):
    """{file name: (start, end)} out of the package's loader script."""
    pattern = r'"filename":\s*"([^"]*)",\s*"start":\s*(\d+),\s*"end":\s*(\d+)'
    return {os.path.basename(name): (int(start), int(end))
            for name, start, end in re.findall(pattern, loader_text)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--assets", required=True, help="face_mesh_solution_packed_assets.data")
    parser.add_argument("--loader", required=True, help="its loader script, which lists the files")
    parser.add_argument("--out", required=True, help="folder for the ONNX files")
    args = parser.parse_args()
    try:
        with open(args.loader, encoding="utf-8") as file:
            places = packed_files(file.read())
        with open(args.assets, "rb") as file:
            assets = file.read()
        os.makedirs(args.out, exist_ok=True)
        for name, (out_name, output_names) in NETWORKS.items():
            if name not in places:
                raise FormatError(f"{args.loader}: lists no {name}")
            start, end = places[name]
            model = Converter(read_model(assets[start:end]), output_names).convert()
            path = os.path.join(args.out, out_name)
            onnx.save(model, path + ".partial")
            os.replace(path + ".partial", path)
            print(f"{path}: {os.path.getsize(path)} bytes")
    except (OSError, FormatError) as error:
        sys.exit(f"convert_networks.py: {error}")


if __name__ == "__main__":
    main()
