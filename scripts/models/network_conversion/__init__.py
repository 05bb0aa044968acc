"""Published weights of networks to ONNX files that OpenCV's DNN module loads."""
