// Safe calls of libyoro: sizes are set, errors are exceptions with yoro's sentence, contexts are disposed. Everything else
// is in Yoro.cs, which is generated from the source of yoro.h. Compile both with -unsafe.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Yoro
{
    /// <summary>An error of yoro, with one sentence about the mistake and the remedy.</summary>
    public sealed class YoroException : Exception
    {
        /// <summary>One of the negative YORO_ERROR_ codes.</summary>
        public readonly int Result;

        internal YoroException(int result, string sentence) : base(sentence) { Result = result; }
    }

    /// <summary>Unity finds this attribute by its name, and compiles the method so that native code can call it.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }

    internal static unsafe class Errors
    {
        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        private delegate void Receiver(void* user, int result, byte* sentence);

        // Kept for as long as the library may call it.
        private static readonly Receiver receiver = Receive;
        [ThreadStatic] private static string newest;

        internal static YoroMessages Messages
        {
            get { return new YoroMessages { callback = (void*)Marshal.GetFunctionPointerForDelegate(receiver) }; }
        }

        [MonoPInvokeCallback(typeof(Receiver))]
        private static void Receive(void* user, int result, byte* sentence) { newest = Text(sentence); }

        internal static void Check(int result)
        {
            string sentence = newest;
            newest = null;
            if (result != Native.YORO_OK)
                throw new YoroException(result, sentence ?? Text(Native.yoro_result_text(result)));
        }

        private static string Text(byte* text)
        {
            int length = 0;
            while (text[length] != 0) length++;
            return Encoding.UTF8.GetString(text, length);
        }
    }

    /// <summary>The frame of two eyes. Call it from any thread.</summary>
    public static unsafe class Stereo
    {
        /// <summary>Returns what to render for two eyes given as poses and angles, and how the other eye is made of it.</summary>
        public static YoroViews Views(YoroEyes eyes)
        {
            var views = new YoroViews { struct_size = (uint)sizeof(YoroViews) };
            Complete(ref eyes);
            Errors.Check(Native.yoro_views_from_eyes(&eyes, &views));
            return views;
        }

        /// <summary>The same for two eyes given as matrices, left-handed worlds included.</summary>
        public static YoroViews Views(YoroMatrices matrices)
        {
            var views = new YoroViews { struct_size = (uint)sizeof(YoroViews) };
            matrices.struct_size = (uint)sizeof(YoroMatrices);
            matrices.messages = Errors.Messages;
            Errors.Check(Native.yoro_views_from_matrices(&matrices, &views));
            return views;
        }

        /// <summary>Returns the two levels of a foveated frame, and how each eye is composed of them, left eye first.</summary>
        public static YoroComposition[] Levels(
            YoroEyes eyes, YoroFoveation foveation, out YoroViews wide, out YoroViews inset)
        {
            var compositions = new YoroComposition[2];
            var views = stackalloc YoroViews[2];
            views[0].struct_size = views[1].struct_size = (uint)sizeof(YoroViews);
            Complete(ref eyes);
            foveation.struct_size = (uint)sizeof(YoroFoveation);
            fixed (YoroComposition* of = compositions)
                Errors.Check(Native.yoro_levels_from_eyes(&eyes, &foveation, &views[0], &views[1], of));
            wide = views[0];
            inset = views[1];
            return compositions;
        }

        private static void Complete(ref YoroEyes eyes)
        {
            eyes.struct_size = (uint)sizeof(YoroEyes);
            eyes.messages = Errors.Messages;
        }
    }

    /// <summary>Finds out whether two renders or the synthesis is cheaper. Use it from one thread at a time.</summary>
    public sealed unsafe class Chooser : IDisposable
    {
        private YoroChooser* chooser;

        /// <summary>Begins with one of the YORO_WAY_ constants.</summary>
        public Chooser(uint first)
        {
            YoroChooser* created = null;
            Errors.Check(Native.yoro_chooser_create(first, &created));
            chooser = created;
        }

        /// <summary>Tells what a frame has cost, and returns how the next one is rendered.</summary>
        public YoroChoice EndFrame(YoroFrameEnd frame)
        {
            var choice = new YoroChoice { struct_size = (uint)sizeof(YoroChoice) };
            frame.struct_size = (uint)sizeof(YoroFrameEnd);
            frame.messages = Errors.Messages;
            Errors.Check(Native.yoro_chooser_end_frame(chooser, &frame, &choice));
            return choice;
        }

        /// <summary>Measures again, because the scene is another one.</summary>
        public void SceneChanged() { Errors.Check(Native.yoro_chooser_scene_changed(chooser)); }

        /// <summary>Frees the chooser.</summary>
        public void Dispose()
        {
            Native.yoro_chooser_destroy(chooser);
            chooser = null;
        }
    }

    /// <summary>The synthesis in the OpenGL context that is current. All calls, Dispose included, are made there.</summary>
    public sealed unsafe class GlSynthesis : IDisposable
    {
        private YoroContext* context;

        /// <summary>Compiles the shaders. The loader is a pointer to eglGetProcAddress or its like.</summary>
        public GlSynthesis(YoroGlInfo info, IntPtr loader)
        {
            YoroContext* created = null;
            info.struct_size = (uint)sizeof(YoroGlInfo);
            info.loader = (void*)loader;
            info.messages = Errors.Messages;
            Errors.Check(Native.yoro_gl_create(&info, &created));
            context = created;
        }

        /// <summary>For the calls of Yoro.cs that this class does not have.</summary>
        public YoroContext* Context { get { return context; } }

        /// <summary>Allocates what frames of this size need, so that none of them does.</summary>
        public void Prepare(YoroWarp warp) { Errors.Check(Native.yoro_gl_prepare(context, &warp)); }

        /// <summary>Draws the other eye.</summary>
        public void Synthesize(YoroWarp warp, YoroGlImages images)
        {
            images.struct_size = (uint)sizeof(YoroGlImages);
            Errors.Check(Native.yoro_gl_synthesize(context, &warp, &images));
        }

        /// <summary>Composes an eye of its two levels.</summary>
        public void Compose(YoroComposition composition, YoroGlLevels levels)
        {
            levels.struct_size = (uint)sizeof(YoroGlLevels);
            Errors.Check(Native.yoro_gl_compose(context, &composition, &levels));
        }

        /// <summary>Frees the shaders and buffers.</summary>
        public void Dispose()
        {
            if (context == null) return;
            int result = Native.yoro_destroy(context);
            // Another thread is inside a call: nothing was freed.
            if (result != Native.YORO_ERROR_BUSY) context = null;
            Errors.Check(result);
        }
    }
}
