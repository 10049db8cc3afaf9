// Calls the library from C#, as any other language would without its header: mono calls.exe PICTURE.png
// Prints the bytes of what it gets, which the test compares with C's.
using System;
using System.Runtime.InteropServices;
using Yoro;

static unsafe class Calls
{
    // A stand-in for an engine, which has a context without a window.
    [StructLayout(LayoutKind.Sequential)]
    struct Image { public uint framebuffer, color, depth; public int width, height; }
    [DllImport("engine")] static extern IntPtr engine_begin();
    [DllImport("engine")] static extern Image engine_image(uint width, uint height);
    [DllImport("engine")] static extern void engine_draw(float* projection, float* view, ref Image image);
    [DllImport("engine")] static extern void engine_report(string path, ref Image made, ref Image source, int x, int y, ref Image truth);

    static string Hex(void* value, int size)
    {
        var bytes = new byte[size];
        Marshal.Copy((IntPtr)value, bytes, 0, size);
        return BitConverter.ToString(bytes).Replace("-", "").ToLower();
    }

    static void Print(string name, YoroViews views)
    {
        // One by one, since there is padding before the warp.
        string images = Hex(&views.source, sizeof(YoroView)) + Hex(&views.rendered, sizeof(YoroView)) + Hex(&views.synthesized, sizeof(YoroView));
        Console.WriteLine(name + " " + Hex(&views.crop_x, 4) + Hex(&views.crop_y, 4) + images + Hex(&views.warp, sizeof(YoroWarp)));
    }

    static void Expect(bool is_so, string what)
    {
        if (!is_so) throw new Exception(what);
    }

    static YoroEyes Eyes()
    {
        var eyes = new YoroEyes { rendered = Native.YORO_EYE_RIGHT, width = 512, height = 512, near_z = 0.1f, far_z = 100, guard_band = Native.YORO_GUARD_BAND };
        eyes.poses_left.orientation[3] = eyes.poses_right.orientation[3] = 1;
        eyes.poses_left.position[0] = -0.0315f;
        eyes.poses_right.position[0] = 0.0315f;
        eyes.poses_left.position[1] = eyes.poses_right.position[1] = 1.6f;
        eyes.poses_left.position[2] = eyes.poses_right.position[2] = 2;
        eyes.fovs_left = new YoroFov { angle_left = -0.7f, angle_right = 0.6f, angle_up = 0.65f, angle_down = -0.65f };
        eyes.fovs_right = new YoroFov { angle_left = -0.6f, angle_right = 0.7f, angle_up = 0.65f, angle_down = -0.65f };
        return eyes;
    }

    static void Main(string[] arguments)
    {
        Console.WriteLine("version " + Native.yoro_version());
        YoroEyes eyes = Eyes();
        YoroViews views = Stereo.Views(eyes);
        Print("eyes", views);

        // Unity's world has z ahead: the third column of each view matrix changes its sign.
        var matrices = new YoroMatrices { rendered = eyes.rendered, width = 512, height = 512, guard_band = eyes.guard_band };
        for (int i = 0; i < 16; i++)
        {
            float hand = i / 4 == 2 ? -1 : 1;
            matrices.view[i] = hand * views.synthesized.view[i];
            matrices.view[16 + i] = hand * views.rendered.view[i];
            matrices.projection[i] = views.synthesized.projection[i];
            matrices.projection[16 + i] = views.rendered.projection[i];
        }
        Print("matrices", Stereo.Views(matrices));

        // Depth is reversed if the planes of the projections are.
        for (int i = 2; i < 32; i += 4) matrices.projection[i] = -matrices.projection[i];
        Expect(Stereo.Views(matrices).warp.depth == Native.YORO_DEPTH_REVERSED, "reversed depth is not seen");

        YoroViews wide, inset;
        var foveation = new YoroFoveation { level = Native.YORO_FOVEATION_MEDIUM };
        YoroComposition[] compositions = Stereo.Levels(eyes, foveation, out wide, out inset);
        Print("wide", wide);
        Print("inset", inset);
        foreach (YoroComposition each in compositions)
        {
            YoroComposition composition = each;
            Console.WriteLine("composition " + Hex(&composition, sizeof(YoroComposition)));
        }

        using (var chooser = new Chooser(Native.YORO_WAY_SYNTHESIS))
        {
            string ways = "";
            for (int frame = 0; frame < 200; frame++)
                ways += chooser.EndFrame(new YoroFrameEnd { rendered = Native.YORO_WAY_OTHER, now_ns = frame * 11111111L, refresh_hz = 90 }).next;
            Console.WriteLine("ways " + ways);
        }

        // Errors are exceptions with their sentence; a size that this library does not know is refused.
        try
        {
            YoroEyes wrong = eyes;
            wrong.near_z = float.NaN;
            Stereo.Views(wrong);
            Expect(false, "NaN is accepted");
        }
        catch (YoroException error)
        {
            Expect(error.Result == Native.YORO_ERROR_VALUE && error.Message.Contains("near"), error.Message);
        }
        eyes.struct_size = 8;
        Expect(Native.yoro_views_from_eyes(&eyes, &views) == Native.YORO_ERROR_STRUCT_SIZE, "a wrong size is accepted");

        if (arguments.Length == 0) return;
        IntPtr loader = engine_begin();
        var info = new YoroGlInfo { outputs = Native.YORO_OUTPUT_DEPTH, state = Native.YORO_GL_STATE_PRESERVE, check = 1 };
        using (var synthesis = new GlSynthesis(info, loader))
        {
            synthesis.Prepare(views.warp);
            Image source = engine_image(views.source.width, views.source.height);
            engine_draw(views.source.projection, views.source.view, ref source);
            Image other = engine_image(512, 512), truth = engine_image(512, 512);
            synthesis.Synthesize(views.warp, new YoroGlImages { color_texture = source.color, depth_texture = source.depth, framebuffer = other.framebuffer });
            engine_draw(views.synthesized.projection, views.synthesized.view, ref truth);
            engine_report(arguments[0], ref other, ref source, (int)views.crop_x, (int)views.crop_y, ref truth);
        }
    }
}
